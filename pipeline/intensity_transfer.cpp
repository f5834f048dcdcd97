#include "pipeline/intensity_transfer.h"

#include <algorithm>
#include <array>

#include "raster/check.h"

namespace gnomon::pipeline {

bool in_first_set(std::uint64_t source, double first_share) {
  std::uint64_t x = source + 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  x ^= x >> 31;
  return static_cast<double>(x >> 11) < first_share * 9007199254740992.0;
}

void intensity_transfers(const ToneCurve& tone, const glm::dvec3& light,
                         std::span<const glm::vec3> transfers,
                         std::span<const std::uint8_t> first_set, std::span<glm::vec3> values) {
  raster::require(transfers.size() == values.size() && transfers.size() == first_set.size(),
                  "a source has a transfer, a set and a value");
  // What is left of the light with the sources of a set so far taken away, and its value; `near` is
  // where the next value is looked for.
  struct Set {
    glm::dvec3 left, value;
    std::array<std::size_t, 3> near{};
  };
  Set first{light, glm::dvec3(0.0), {}};
  for (std::size_t c = 0; c < 3; ++c) {
    const int channel = static_cast<int>(c);
    first.value[channel] = tone.value(c, light[channel]);
    first.near[c] = std::min(static_cast<std::size_t>(first.value[channel]), std::size_t{254});
  }
  std::array<Set, 2> sets{first, first};
  for (std::size_t j = 0; j < transfers.size(); ++j) {
    values[j] = glm::vec3(0.0f);
    if (transfers[j] == glm::vec3(0.0f)) continue;
    Set& set = sets[first_set[j] ? 0 : 1];
    set.left -= glm::dvec3(transfers[j]);
    for (std::size_t c = 0; c < 3; ++c) {
      const int channel = static_cast<int>(c);
      const double after = tone.value_from(c, set.left[channel], set.near[c]);
      values[j][channel] = static_cast<float>(set.value[channel] - after);
      set.value[channel] = after;
    }
  }
}

}  // namespace gnomon::pipeline
