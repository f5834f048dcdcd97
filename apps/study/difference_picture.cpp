#include "apps/study/difference_picture.h"

#include <algorithm>
#include <cstdlib>

namespace gnomon::apps::study {

ar::Image difference_picture(const ar::Image& reference, const ar::Image& test) {
  constexpr int kGain = 8;
  ar::Image out{test.width, test.height, 3, {}};
  out.pixels.reserve(test.pixels.size());
  for (std::size_t i = 0; i + 2 < test.pixels.size(); i += 3) {
    int sum = 0, off = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      sum += test.pixels[i + c];
      off += test.pixels[i + c] - reference.pixels[i + c];
    }
    const int grey = sum / 9;
    const int strong = std::min(255, grey + kGain * std::abs(off) / 3);
    for (const int value : {off < 0 ? strong : grey, grey, off > 0 ? strong : grey})
      out.pixels.push_back(static_cast<std::uint8_t>(value));
  }
  return out;
}

}  // namespace gnomon::apps::study
