// The last step of differential shadows: what a frame's shadows left in its colour target, and the
// photograph, become the augmented photograph's values.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "pipeline/differential_shadows.h"
#include "pipeline/tone_curve.h"
#include "raster/buffers.h"
#include "raster/image_view.h"

namespace gnomon::pipeline {

/// One pixel at a time. Refers to the tone curve.
class PictureFinish {
 public:
  /// `options` are those of the recording.
  PictureFinish(const ToneCurve& tone, const ShadowTakeOptions& options);

  /// Red, green, blue of a pixel. Without an object (alpha 0): T of the part of the photograph's
  /// radiance that is left, or what was drawn, or T of the photograph's radiance less what was
  /// taken; of an object its value, or T of its radiance. Rounded to nearest.
  std::array<std::uint8_t, 3> pixel(const std::uint8_t* photograph,
                                    const raster::Rgba8& drawn) const;
  std::array<std::uint8_t, 3> pixel(const std::uint8_t* photograph, const glm::vec4& drawn) const;

  /// There is no object and nothing was taken by share: the photograph keeps its value.
  bool keeps(const raster::Rgba8& drawn) const {
    return by_share_ && std::bit_cast<std::uint32_t>(drawn) == kWhite;
  }
  bool keeps(const glm::vec4& drawn) const {
    const float whole = radiance_ ? 0.0f : 1.0f;
    return by_share_ && drawn == glm::vec4(whole, whole, whole, 0.0f);
  }

 private:
  static constexpr std::uint32_t kWhite =
      std::bit_cast<std::uint32_t>(raster::Rgba8{255, 255, 255, 0});
  const ToneCurve& tone_;
  bool radiance_, by_share_;
  /// By channel, photograph's value and part of 255 that is left; of by_share in bytes.
  std::vector<std::uint8_t> left_;
};

/// All pixels: rows r, g, b, a from the bottom row, a as in `drawn`. A pixel that nothing was taken
/// from has the photograph's bytes.
/// Precondition: `drawn` is the recording's target and of the photograph's size.
std::vector<std::uint8_t> finish_picture(const raster::ImageView& photograph,
                                         const raster::ColorBuffer& drawn, const ToneCurve& tone,
                                         const ShadowTakeOptions& options);

}  // namespace gnomon::pipeline
