#include "pipeline/finish_picture.h"

#include <algorithm>
#include <cmath>

#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

std::uint8_t nearest(double value) {
  // NaN is not more than 0.
  return value > 0.0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 255.0))) : 0;
}

}  // namespace

PictureFinish::PictureFinish(const ToneCurve& tone, const ShadowTakeOptions& options)
    : tone_(tone),
      radiance_(options.precision == ShadowPrecision::radiance),
      by_share_(options.by_share) {
  if (!by_share_) return;
  left_.reserve(std::size_t{3} * 256 * 256);
  for (std::size_t c = 0; c < 3; ++c) {
    for (int value = 0; value < 256; ++value) {
      const double light = tone.radiance(c, value);
      for (int part = 0; part < 256; ++part)
        left_.push_back(nearest(tone.value(c, light * (part / 255.0))));
      left_.back() = static_cast<std::uint8_t>(value);
    }
  }
}

std::array<std::uint8_t, 3> PictureFinish::pixel(const std::uint8_t* photograph,
                                                 const raster::Rgba8& drawn) const {
  if (drawn[3] != 0 || !by_share_) return {drawn[0], drawn[1], drawn[2]};
  std::array<std::uint8_t, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = left_[(c * 256 + photograph[c]) * 256 + drawn[c]];
  return out;
}

std::array<std::uint8_t, 3> PictureFinish::pixel(const std::uint8_t* photograph,
                                                 const glm::vec4& drawn) const {
  const bool object = drawn.w != 0.0f;
  std::array<std::uint8_t, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = static_cast<double>(drawn[static_cast<int>(c)]);
    if (object) {
      out[c] = nearest(radiance_ ? tone_.value(c, value) : 255.0 * value);
    } else if (by_share_) {
      const double part = radiance_ ? 1.0 + value : value;
      out[c] = part == 1.0 ? photograph[c]
                           : nearest(tone_.value(c, tone_.radiance(c, photograph[c]) * part));
    } else if (radiance_) {
      out[c] = value == 0.0 ? photograph[c]
                            : nearest(tone_.value(c, tone_.radiance(c, photograph[c]) + value));
    } else {
      out[c] = nearest(255.0 * value);
    }
  }
  return out;
}

std::vector<std::uint8_t> finish_picture(const raster::ImageView& photograph,
                                         const raster::ColorBuffer& drawn, const ToneCurve& tone,
                                         const ShadowTakeOptions& options) {
  raster::require(drawn.width() == photograph.width && drawn.height() == photograph.height,
                  "drawing and photograph have one size");
  const PictureFinish finish(tone, options);
  const auto width = static_cast<std::size_t>(drawn.width());
  std::vector<std::uint8_t> rows(4 * width * static_cast<std::size_t>(drawn.height()));
  const auto finish_row = [&](int y, const auto& plane, const auto& opaque) {
    std::uint8_t* out = &rows[4 * width * static_cast<std::size_t>(y)];
    for (int x = 0; x < drawn.width(); ++x, out += 4) {
      const auto& at = plane.at(x, y);
      std::ranges::copy(finish.pixel(photograph.pixel(x, y), at), out);
      out[3] = opaque(at);
    }
  };
  constexpr std::size_t kRows = 16;
  raster::for_each_chunk(static_cast<std::size_t>(drawn.height()), kRows, options.threads,
                         [&](std::size_t first, std::size_t last) {
                           for (std::size_t y = first; y < last; ++y) {
                             if (drawn.format() == raster::ColorFormat::rgba8)
                               finish_row(static_cast<int>(y), drawn.rgba8(),
                                          [](const raster::Rgba8& at) { return at[3]; });
                             else
                               finish_row(
                                   static_cast<int>(y), drawn.rgba32f(), [](const glm::vec4& at) {
                                     return at.w != 0.0f ? std::uint8_t{255} : std::uint8_t{0};
                                   });
                           }
                         });
  return rows;
}

}  // namespace gnomon::pipeline
