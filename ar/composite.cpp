#include "ar/composite.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::ar {

namespace {

/// Of the photograph, one thread's at a time.
constexpr std::size_t kRows = 16;

/// View pixels u0 <= u < u1, v0 <= v < v1, v from the top.
struct Footprint {
  int u0, v0, u1, v1;
  int count() const { return std::max(0, u1 - u0) * std::max(0, v1 - v0); }
};

/// The `samples` x `samples` view pixels round a point, inside the view.
Footprint footprint(const PinholeView& view, glm::vec2 center) {
  const auto start = [&](float c) {
    return static_cast<int>(std::floor(c - 0.5f * static_cast<float>(view.samples() - 1) + 0.5f));
  };
  const int u = start(center.x), v = start(center.y);
  return {std::max(u, 0), std::max(v, 0), std::min(u + view.samples(), view.width()),
          std::min(v + view.samples(), view.height())};
}

/// Index of a view pixel in rows that begin at the bottom.
std::size_t from_bottom(const PinholeView& view, int u, int v) {
  return static_cast<std::size_t>(view.height() - 1 - v) * view.width() + u;
}

bool untouched(const PinholeView& view, const Footprint& at, const Image& resampled,
               const std::vector<std::uint8_t>& drawn) {
  for (int v = at.v0; v < at.v1; ++v)
    for (int u = at.u0; u < at.u1; ++u) {
      const std::uint8_t* d = drawn.data() + 4 * from_bottom(view, u, v);
      const std::uint8_t* b = resampled.at(u, v);
      if (d[3] != 0 || d[0] != b[0] || d[1] != b[1] || d[2] != b[2]) return false;
    }
  return true;
}

/// Sums over a footprint's view pixels.
struct Sums {
  double object_share = 0.0;
  glm::dvec3 object_color{0.0}, drawn{0.0}, resampled{0.0};
};

Sums gather(const PinholeView& view, const Footprint& at, const Image& resampled,
            const std::vector<std::uint8_t>& drawn) {
  Sums sum;
  for (int v = at.v0; v < at.v1; ++v)
    for (int u = at.u0; u < at.u1; ++u) {
      const std::uint8_t* d = drawn.data() + 4 * from_bottom(view, u, v);
      const std::uint8_t* b = resampled.at(u, v);
      const double alpha = d[3] / 255.0;
      sum.object_share += alpha;
      for (int c = 0; c < 3; ++c) {
        sum.object_color[c] += alpha * d[c];
        sum.drawn[c] += (1.0 - alpha) * d[c];
        sum.resampled[c] += (1.0 - alpha) * b[c];
      }
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
  const auto first = [](double from) {
    return std::max(0, static_cast<int>(std::floor(from + 0.5)));
  };
  const auto end = [](double to, int size) {
    return std::min(size, static_cast<int>(std::ceil(to + 0.5)));
  };
  const int u0 = first(low.x), u1 = end(high.x, view.width());
  const int v0 = first(low.y), v1 = end(high.y, view.height());
  bool any = false;
  for (int v = v0; v < v1; ++v)
    for (int u = u0; u < u1; ++u) any |= rgba_rows[4 * from_bottom(view, u, v) + channel] != 0;
  if (!any) return 0.0;
  const auto weight = [](int i, double from, double to) {
    return std::max(0.0, std::min(i + 0.5, to) - std::max(i - 0.5, from));
  };
  double covered = 0.0, total = 0.0;
  for (int v = v0; v < v1; ++v)
    for (int u = u0; u < u1; ++u) {
      const double area = weight(u, low.x, high.x) * weight(v, low.y, high.y);
      total += area;
      if (rgba_rows[4 * from_bottom(view, u, v) + channel] != 0) covered += area;
    }
  return total > 0.0 ? covered / total : 0.0;
}

Image composite(const PinholeView& view, const Image& photograph, const Image& resampled,
                const std::vector<std::uint8_t>& drawn_rows, int threads) {
  raster::require(drawn_rows.size() == std::size_t{4} * view.width() * view.height() &&
                      resampled.width == view.width() && resampled.height == view.height(),
                  "the drawing and the resampled photograph have the view's size");
  Image out = photograph;
  const auto take_row = [&](int y) {
    const std::uint8_t* from = &drawn_rows[4 * from_bottom(view, 0, y)];
    std::uint8_t* to = out.at(0, y);
    for (int x = 0; x < out.width; ++x, from += 4, to += 3) std::copy_n(from, 3, to);
  };
  const auto mix_row = [&](int y) {
    for (int x = 0; x < out.width; ++x) {
      const glm::vec2 center = view.view_from_photo(x, y);
      if (std::isnan(center.x)) continue;
      const Footprint at = footprint(view, center);
      if (untouched(view, at, resampled, drawn_rows)) continue;
      const Sums sum = gather(view, at, resampled, drawn_rows);
      const double share = sum.object_share / at.count();
      for (int c = 0; c < 3; ++c) {
        const double kept = sum.resampled[c] > 0.0 ? sum.drawn[c] / sum.resampled[c] : 1.0;
        const double value =
            sum.object_color[c] / at.count() + (1.0 - share) * kept * photograph.at(x, y)[c];
        out.at(x, y)[c] = static_cast<std::uint8_t>(std::lrint(std::clamp(value, 0.0, 255.0)));
      }
    }
  };
  raster::for_each_chunk(static_cast<std::size_t>(out.height), kRows, threads,
                         [&](std::size_t first, std::size_t last) {
                           for (std::size_t y = first; y < last; ++y) {
                             const int row = static_cast<int>(y);
                             view.is_identity() ? take_row(row) : mix_row(row);
                           }
                         });
  return out;
}

namespace {

template <class Pixel>
void finish_row(const PinholeView& view, const raster::TiledPlane<Pixel>& drawn,
                const pipeline::PictureFinish& finish, int y, Image& picture) {
  for (int x = 0; x < picture.width; ++x) {
    if (view.samples() == 1) {
      const auto [u, v] = view.nearest(x, y);
      if (u < 0) continue;
      const Pixel& pixel = drawn.at(u, v);
      if (!finish.keeps(pixel))
        std::ranges::copy(finish.pixel(picture.at(x, y), pixel), picture.at(x, y));
      continue;
    }
    const glm::vec2 center = view.view_from_photo(x, y);
    if (std::isnan(center.x)) continue;
    const Footprint at = footprint(view, center);
    bool keeps = true;
    std::array<int, 3> sum{};
    for (int v = at.v0; v < at.v1; ++v) {
      for (int u = at.u0; u < at.u1; ++u) {
        const Pixel& pixel = drawn.at(u, view.height() - 1 - v);
        const bool kept = finish.keeps(pixel);
        keeps = keeps && kept;
        std::array<std::uint8_t, 3> value{};
        if (kept)
          std::copy_n(picture.at(x, y), 3, value.begin());
        else
          value = finish.pixel(picture.at(x, y), pixel);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += value[c];
      }
    }
    if (keeps) continue;
    const int count = at.count();
    for (std::size_t c = 0; c < 3; ++c)
      picture.at(x, y)[c] = static_cast<std::uint8_t>((2 * sum[c] + count) / (2 * count));
  }
}

}  // namespace

Image composite(const PinholeView& view, const Image& photograph, const raster::ColorBuffer& drawn,
                const pipeline::PictureFinish& finish, int threads) {
  raster::require(drawn.width() == view.width() && drawn.height() == view.height(),
                  "the drawing has the view's size");
  raster::require(photograph.channels == 3 && photograph.width == view.photo_width() &&
                      photograph.height == view.photo_height(),
                  "the photograph has three channels and the camera's size");
  Image out = photograph;
  raster::for_each_chunk(static_cast<std::size_t>(out.height), kRows, threads,
                         [&](std::size_t first, std::size_t last) {
                           for (std::size_t y = first; y < last; ++y) {
                             if (drawn.format() == raster::ColorFormat::rgba8)
                               finish_row(view, drawn.rgba8(), finish, static_cast<int>(y), out);
                             else
                               finish_row(view, drawn.rgba32f(), finish, static_cast<int>(y), out);
                           }
                         });
  return out;
}

}  // namespace gnomon::ar
