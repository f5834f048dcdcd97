// What a live window shows and what its keys do; the window itself is live_window.h.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ar/image.h"
#include "ar/pass_pictures.h"

namespace gnomon::apps {

class LiveView {
 public:
  enum class Buffer { composite, color, depth, stencil };

  /// A key's character: 1 the augmented picture; c, d, s colour, depth and stencil after a pass;
  /// n, p the next and the previous pass; space stops and goes on; h the keys; q or escape ends.
  void press(int key);

  Buffer buffer() const { return buffer_; }
  /// The buffers after every pass are needed.
  bool wants_steps() const { return buffer_ != Buffer::composite; }
  bool paused() const { return paused_; }
  bool ended() const { return ended_; }
  bool help() const { return help_; }

  /// How many passes the picture has that comes next.
  void see(std::size_t passes);
  /// Of the picture and what its passes left: the picture itself where there are no passes.
  /// Precondition: see(steps.size()) came before.
  const ar::Image& picture(const ar::Image& composite,
                           const std::vector<ar::PassPictures>& steps) const;
  /// As above: "stencil after pass 3 of 7: step 2: ...".
  std::string caption(const std::vector<ar::PassPictures>& steps) const;

 private:
  Buffer buffer_ = Buffer::composite;
  /// How many passes before the last one.
  std::size_t back_ = 0;
  bool paused_ = false, ended_ = false, help_ = false;
};

/// The keys, a line each.
const std::vector<std::string>& live_keys();

}  // namespace gnomon::apps
