#include "pipeline/intensity_transfer.h"

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
  glm::dvec3 left[2] = {light, light};
  const glm::dvec3 value = tone.value(light);
  glm::dvec3 before[2] = {value, value};
  for (std::size_t j = 0; j < transfers.size(); ++j) {
    const std::size_t set = first_set[j] ? 0 : 1;
    left[set] -= glm::dvec3(transfers[j]);
    const glm::dvec3 after = tone.value(left[set]);
    values[j] = glm::vec3(before[set] - after);
    before[set] = after;
  }
}

}  // namespace gnomon::pipeline
