#include "ar/composite.h"

#include <algorithm>
#include <cmath>

#include "raster/check.h"

namespace gnomon::ar {

namespace {

/// Sums over the view pixels under one pixel of the photograph.
struct Footprint {
  int count = 0;
  bool changed = false;
  double object_share = 0.0;
  glm::dvec3 object_color{0.0}, drawn{0.0}, resampled{0.0};
};

/// The view pixel where a footprint of `samples` pixels round `center` begins.
int footprint_start(float center, int samples) {
  return static_cast<int>(std::floor(center - 0.5f * static_cast<float>(samples - 1) + 0.5f));
}

Footprint gather(const PinholeView& view, glm::vec2 center, const Image& resampled,
                 const std::vector<std::uint8_t>& drawn) {
  Footprint sum;
  const int samples = view.samples();
  const int u0 = footprint_start(center.x, samples), v0 = footprint_start(center.y, samples);
  for (int v = std::max(v0, 0); v < std::min(v0 + samples, view.height()); ++v)
    for (int u = std::max(u0, 0); u < std::min(u0 + samples, view.width()); ++u) {
      const std::size_t from_bottom =
          static_cast<std::size_t>(view.height() - 1 - v) * view.width() + u;
      const std::uint8_t* d = drawn.data() + 4 * from_bottom;
      const std::uint8_t* b = resampled.at(u, v);
      sum.changed |= d[3] != 0 || d[0] != b[0] || d[1] != b[1] || d[2] != b[2];
      const double alpha = d[3] / 255.0;
      sum.object_share += alpha;
      for (int c = 0; c < 3; ++c) {
        sum.object_color[c] += alpha * d[c];
        sum.drawn[c] += (1.0 - alpha) * d[c];
        sum.resampled[c] += (1.0 - alpha) * b[c];
      }
      ++sum.count;
    }
  return sum;
}

}  // namespace

double covered_share(const PinholeView& view, const std::vector<std::uint8_t>& rgba_rows,
                     std::size_t channel, int x, int y) {
  const glm::vec2 center = view.view_from_photo(x, y);
  if (std::isnan(center.x)) return 0.0;
  // Pixel u of the view spans [u - 1/2, u + 1/2].
  const double half = 0.5 * view.samples();
  const glm::dvec2 low = glm::dvec2(center) - half, high = glm::dvec2(center) + half;
  const auto weight = [](int i, double from, double to) {
    return std::max(0.0, std::min(i + 0.5, to) - std::max(i - 0.5, from));
  };
  double covered = 0.0, total = 0.0;
  for (int v = std::max(0, static_cast<int>(std::floor(low.y + 0.5)));
       v < view.height() && v - 0.5 < high.y; ++v)
    for (int u = std::max(0, static_cast<int>(std::floor(low.x + 0.5)));
         u < view.width() && u - 0.5 < high.x; ++u) {
      const double area = weight(u, low.x, high.x) * weight(v, low.y, high.y);
      const std::size_t i = static_cast<std::size_t>(view.height() - 1 - v) * view.width() + u;
      total += area;
      if (rgba_rows[4 * i + channel] != 0) covered += area;
    }
  return total > 0.0 ? covered / total : 0.0;
}

Image composite(const PinholeView& view, const Image& photograph, const Image& resampled,
                const raster::ColorBuffer& drawn) {
  raster::require(drawn.width() == view.width() && drawn.height() == view.height() &&
                      resampled.width == view.width() && resampled.height == view.height(),
                  "the drawing and the resampled photograph have the view's size");
  const std::vector<std::uint8_t> rows = drawn.to_rgba8_rows();
  Image out = photograph;
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const glm::vec2 center = view.view_from_photo(x, y);
      if (std::isnan(center.x)) continue;
      const Footprint sum = gather(view, center, resampled, rows);
      if (!sum.changed) continue;
      const double share = sum.object_share / sum.count;
      for (int c = 0; c < 3; ++c) {
        const double kept = sum.resampled[c] > 0.0 ? sum.drawn[c] / sum.resampled[c] : 1.0;
        const double value =
            sum.object_color[c] / sum.count + (1.0 - share) * kept * photograph.at(x, y)[c];
        out.at(x, y)[c] = static_cast<std::uint8_t>(std::lrint(std::clamp(value, 0.0, 255.0)));
      }
    }
  return out;
}

}  // namespace gnomon::ar
