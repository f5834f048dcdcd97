// A frame under inspection: its buffers after any number of commands, the fates of fragments, a
// pixel's history.
// Invariant: what is shown is what execute() leaves; asking changes nothing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "apps/inspector/frame_buffers.h"
#include "apps/inspector/wireframe.h"
#include "raster/draw_fates.h"
#include "raster/execute.h"

namespace gnomon::apps::inspector {

class Inspection {
 public:
  /// `owner` keeps the frame and its buffers, which belong to the inspection from now on and begin
  /// as they are constructed.
  Inspection(std::shared_ptr<const void> owner, const raster::Frame& frame);

  const raster::Frame& frame() const { return frame_; }
  const FrameBuffers& buffers() const { return buffers_; }

  /// Brings the buffers to what the first so many commands leave.
  void seek(std::size_t commands);

  /// Of the draws among commands [first, last) that go to targets of the first one's size. The
  /// position is `last` afterwards. Misuse: no such command.
  raster::DrawFates fates(std::size_t first, std::size_t last);

  /// As JSON (history_json). The position stays. Misuse: as raster::history.
  std::string history(std::size_t pass, int x, int y, std::size_t commands);

  /// Of a draw; empty for others. Misuse: no such command.
  std::vector<WireEdge> wires(std::size_t command) const;

  /// As JSON (frame_json).
  std::string description(bool in_brief = false) const;

 private:
  struct Saved {
    std::size_t commands;
    std::vector<raster::Buffer> buffers;
  };
  void run_to(std::size_t commands);
  bool begins_pass(std::size_t command) const {
    return std::ranges::binary_search(pass_begins_, command);
  }

  std::shared_ptr<const void> owner_;
  const raster::Frame& frame_;
  FrameBuffers buffers_;
  raster::ExecuteMemory memory_;
  std::vector<std::size_t> pass_begins_;
  std::size_t position_ = 0;
  /// At beginnings of passes, in order.
  std::vector<Saved> saved_;
};

}  // namespace gnomon::apps::inspector
