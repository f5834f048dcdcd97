#include "ar/merge_radiance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "raster/executor.h"

namespace gnomon::ar {
namespace {

constexpr std::size_t kPixelsAChunk = 8192;
/// From here on a bright pixel's noise is cut off by saturation, which biases it downwards.
constexpr std::size_t kCut = 245, kSaturated = 253;

struct ValueTable {
  /// Without the time: exposure, and the inverse variance of it.
  std::array<double, 256> exposure{}, weight{};
};

ValueTable table_of(const std::array<double, 256>& exposure) {
  ValueTable table{exposure, {}};
  for (std::size_t v = 1; v < kSaturated; ++v) {
    // Over five values, since a measured curve's single steps are noisy.
    const std::size_t low = v < 3 ? 0 : v - 2, high = v + 2;
    const double step = (exposure[high] - exposure[low]) / static_cast<double>(high - low);
    const double cut =
        v <= kCut ? 1.0
                  : static_cast<double>(kSaturated - v) / static_cast<double>(kSaturated - kCut);
    table.weight[v] = cut / (step * step);
  }
  return table;
}

enum class Seen { well, saturated, black };

Seen merge_channel(const Brackets& brackets, const ValueTable& table, std::size_t at,
                   float& radiance) {
  double sum = 0.0, weights = 0.0;
  for (const Exposure& e : brackets.exposures) {
    const std::size_t value = e.picture.pixels[at];
    const double w = table.weight[value] * e.time_s * e.time_s;
    sum += w * table.exposure[value] / e.time_s;
    weights += w;
  }
  if (weights > 0.0) {
    radiance = static_cast<float>(sum / weights);
    return Seen::well;
  }
  // Black up to some time, saturated from the next on, or one of both throughout.
  for (const Exposure& e : brackets.exposures) {
    const std::size_t value = e.picture.pixels[at];
    if (value < kSaturated) continue;
    radiance = static_cast<float>(table.exposure[value] / e.time_s);
    return Seen::saturated;
  }
  radiance = 0.0f;
  return Seen::black;
}

}  // namespace

MergedRadiance merge_radiance(const Brackets& brackets, const ExposureCurve& curve, int threads) {
  std::array<ValueTable, 3> tables;
  for (std::size_t c = 0; c < 3; ++c) tables[c] = table_of(curve.exposure_from_value[c]);
  const std::size_t pixels = static_cast<std::size_t>(brackets.width()) * brackets.height();
  MergedRadiance merged;
  merged.picture = {brackets.width(), brackets.height(), std::vector<float>(3 * pixels)};
  const std::size_t chunks = (pixels + kPixelsAChunk - 1) / kPixelsAChunk;
  std::vector<std::size_t> saturated(chunks, 0), black(chunks, 0);
  raster::for_each_chunk(pixels, kPixelsAChunk, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      int bright = 0, dark = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Seen seen =
            merge_channel(brackets, tables[c], 3 * i + c, merged.picture.pixels[3 * i + c]);
        bright += seen == Seen::saturated ? 1 : 0;
        dark += seen == Seen::black ? 1 : 0;
      }
      saturated[first / kPixelsAChunk] += bright > 0 ? 1 : 0;
      black[first / kPixelsAChunk] += dark == 3 ? 1 : 0;
    }
  });
  for (std::size_t k = 0; k < chunks; ++k) {
    merged.saturated += saturated[k];
    merged.black += black[k];
  }
  return merged;
}

}  // namespace gnomon::ar
