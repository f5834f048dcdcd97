#include "apps/live_window.h"

#include <cstdlib>

#include <opencv2/highgui.hpp>
#include <opencv2/imgproc.hpp>

#include "ar/error.h"

namespace gnomon::apps {

namespace {

/// The window's library ends the process where it finds no display, so it is not asked.
bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) {
    const char* value = std::getenv(name);
    if (value && *value) return true;
  }
  return false;
}

cv::Mat canvas_of(const ar::Image& image) {
  const cv::Mat pixels(image.height, image.width, image.channels == 1 ? CV_8UC1 : CV_8UC3,
                       const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat out;
  cv::cvtColor(pixels, out, image.channels == 1 ? cv::COLOR_GRAY2BGR : cv::COLOR_RGB2BGR);
  return out;
}

void write(cv::Mat& canvas, const std::string& line, int y) {
  const cv::Point at{8, y};
  cv::putText(canvas, line, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, {0, 0, 0}, 3, cv::LINE_AA);
  cv::putText(canvas, line, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, {255, 255, 255}, 1, cv::LINE_AA);
}

}  // namespace

LiveWindow::LiveWindow(const std::string& title) : title_("gnomon: " + title) {
  if (!has_display())
    throw ar::InputError(
        "--show: there is no display (none of DISPLAY, WAYLAND_DISPLAY and QT_QPA_PLATFORM is "
        "set)");
  try {
    cv::namedWindow(title_, cv::WINDOW_AUTOSIZE);
  } catch (const cv::Exception& error) {
    throw ar::InputError("--show: no window can be opened: " + error.err);
  }
}

LiveWindow::~LiveWindow() {
  try {
    cv::destroyWindow(title_);
  } catch (const cv::Exception&) {
    // It was closed already.
  }
}

bool LiveWindow::is_open() const {
  try {
    return cv::getWindowProperty(title_, cv::WND_PROP_VISIBLE) > 0.0;
  } catch (const cv::Exception&) {
    return false;
  }
}

void LiveWindow::draw(const ar::Image& composite,
                      const std::vector<ar::PassPictures>& steps) const {
  cv::Mat canvas = canvas_of(view_.picture(composite, steps));
  write(canvas, view_.caption(steps), 18);
  if (view_.help()) {
    int y = 40;
    for (const std::string& line : live_keys()) {
      write(canvas, line, y);
      y += 20;
    }
  }
  cv::imshow(title_, canvas);
}

bool LiveWindow::show(const ar::Image& composite, const ar::SessionResult& result) {
  static const std::vector<ar::PassPictures> kNone;
  const auto& steps = result.augmented ? result.augmented->steps : kNone;
  do {
    view_.see(steps.size());
    draw(composite, steps);
    const int key = cv::waitKey(view_.paused() ? 30 : 1);
    if (key >= 0) view_.press(key & 0xff);
    if (view_.ended() || !is_open()) return false;
  } while (view_.paused());
  return true;
}

}  // namespace gnomon::apps
