#include "apps/live_view.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon::apps {

namespace {

constexpr int kEscape = 27;

}  // namespace

const std::vector<std::string>& live_keys() {
  static const std::vector<std::string> kKeys{"1 picture   c colour   d depth   s stencil",
                                              "n next pass   p previous pass",
                                              "space stop, go on   h keys   q end"};
  return kKeys;
}

void LiveView::press(int key) {
  switch (key) {
    case '1':
      buffer_ = Buffer::composite;
      break;
    case 'c':
      buffer_ = Buffer::color;
      break;
    case 'd':
      buffer_ = Buffer::depth;
      break;
    case 's':
      buffer_ = Buffer::stencil;
      break;
    case 'n':
      if (back_ > 0) --back_;
      break;
    case 'p':
      ++back_;
      break;
    case ' ':
      paused_ = !paused_;
      break;
    case 'h':
      help_ = !help_;
      break;
    case 'q':
    case kEscape:
      ended_ = true;
      break;
    default:
      break;
  }
}

void LiveView::see(std::size_t passes) {
  if (passes > 0) back_ = std::min(back_, passes - 1);
}

const ar::Image& LiveView::picture(const ar::Image& composite,
                                   const std::vector<ar::PassPictures>& steps) const {
  if (buffer_ == Buffer::composite || steps.empty()) return composite;
  const ar::PassPictures& step = steps[steps.size() - 1 - back_];
  return buffer_ == Buffer::color   ? step.color
         : buffer_ == Buffer::depth ? step.depth
                                    : step.stencil;
}

std::string LiveView::caption(const std::vector<ar::PassPictures>& steps) const {
  if (buffer_ == Buffer::composite) return "augmented picture";
  if (steps.empty()) return "no passes are kept of this picture; those of the next one are";
  const char* name = buffer_ == Buffer::color   ? "colour"
                     : buffer_ == Buffer::depth ? "depth"
                                                : "stencil";
  const std::size_t pass = steps.size() - 1 - back_;
  return fmt::format("{} after pass {} of {}: {}", name, pass + 1, steps.size(), steps[pass].label);
}

}  // namespace gnomon::apps
