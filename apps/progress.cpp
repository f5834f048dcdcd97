#include "apps/progress.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string>

#include <fmt/format.h>

namespace gnomon::apps {

Progress::Progress(const char* what, std::optional<std::int64_t> total)
    : what_(what), total_(total), shown_(isatty(2) == 1) {}

Progress::~Progress() {
  if (shown_) std::cerr << "\r\033[K";
}

void Progress::show(std::int64_t done) const {
  if (!shown_) return;
  if (!total_ || *total_ <= 0) {
    std::cerr << '\r' << what_ << ' ' << done << std::flush;
    return;
  }
  constexpr int kWidth = 40;
  const int filled = static_cast<int>(std::min<std::int64_t>(kWidth, done * kWidth / *total_));
  std::cerr << fmt::format("\r[{:<{}}] {}/{}", std::string(filled, '#'), kWidth, done, *total_)
            << std::flush;
}

}  // namespace gnomon::apps
