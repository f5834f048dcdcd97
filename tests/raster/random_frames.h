// Seeded random frames: every state that a draw can have, triangles of every kind (tiny, sliver,
// huge, behind the eye, at infinity, on the sub-pixel grid), clears and blits. The same seed gives
// the same frame everywhere (std::mt19937 and own mappings only).
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "raster/frame.h"

namespace gnomon::random_frames {

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  /// Integer in [low, high].
  int integer(int low, int high) {
    const auto span = static_cast<std::uint64_t>(static_cast<std::int64_t>(high) - low + 1);
    return static_cast<int>(low + static_cast<std::int64_t>((engine_() * span) >> 32));
  }
  float real(float low, float high) {
    return low + (high - low) * (static_cast<float>(engine_() >> 8) / 16777216.0f);
  }
  bool chance(float p) { return real(0.0f, 1.0f) < p; }

 private:
  std::mt19937 engine_;
};

/// The buffers of one run and a frame that was recorded for them.
struct Targets {
  raster::ColorBuffer color;
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;

  Targets(int width, int height, raster::ColorFormat color_format, raster::DepthFormat depth_format)
      : color(width, height, color_format),
        depth(width, height, depth_format),
        stencil(width, height) {}

  raster::Targets all() { return {&color, &depth, &stencil}; }
  /// Every byte of the three buffers, row after row.
  std::vector<std::uint8_t> bytes() const;
};

/// Records a pass of `commands` random commands of this seed; all three targets are there.
void record_pass(raster::Frame& frame, std::uint32_t seed, int commands,
                 const raster::Targets& targets);

/// A frame of one such pass.
raster::Frame random_frame(std::uint32_t seed, int commands, Targets& targets);

/// A random fixed-function state.
raster::State random_state(Random& random, int width, int height);

}  // namespace gnomon::random_frames
