// A window that shows a video as it is drawn (OpenCV's highgui), with keys for the buffers.
#pragma once

#include <string>

#include "apps/live_view.h"
#include "ar/image.h"
#include "ar/session.h"

namespace gnomon::apps {

class LiveWindow {
 public:
  /// Throws ar::InputError where there is no display.
  explicit LiveWindow(const std::string& title);
  ~LiveWindow();
  LiveWindow(const LiveWindow&) = delete;
  LiveWindow& operator=(const LiveWindow&) = delete;

  bool wants_steps() const { return view_.wants_steps(); }
  /// Shows a picture and acts on keys; waits while it is paused. False: it is to end, because a key
  /// said so or the window was closed.
  bool show(const ar::Image& composite, const ar::SessionResult& result);

 private:
  void draw(const ar::Image& composite, const std::vector<ar::PassPictures>& steps) const;
  bool is_open() const;

  std::string title_;
  LiveView view_;
};

}  // namespace gnomon::apps
