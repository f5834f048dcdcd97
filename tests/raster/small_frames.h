// Draws of loose triangles whose answer is known: positions, a state, nothing else.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "raster/frame.h"

namespace gnomon::small_frames {

/// A clip-space position at window coordinates (x, y) of a width x height target, depth z in [0,
/// 1].
inline glm::vec4 at_window(double x, double y, int width, int height, double z = 0.5) {
  return {static_cast<float>(2.0 * x / width - 1.0), static_cast<float>(2.0 * y / height - 1.0),
          static_cast<float>(2.0 * z - 1.0), 1.0f};
}

/// Adds 1 for each fragment.
inline raster::State counting() {
  raster::StencilFace face;
  face.pass = raster::StencilOp::incr_wrap;
  return {.stencil = raster::StencilState::both(face), .color = raster::ColorState::off()};
}

/// Adds 1 for each front-facing fragment, takes 1 for each back-facing one.
inline raster::State signed_counting() {
  raster::State state = counting();
  state.stencil->back.pass = raster::StencilOp::decr_wrap;
  return state;
}

/// Three positions a triangle.
inline void draw_positions(raster::Frame& frame, const raster::State& state,
                           std::vector<glm::vec4> positions, int ref = 0) {
  auto kept = std::make_shared<std::pair<std::vector<glm::vec4>, std::vector<std::uint32_t>>>();
  kept->first = std::move(positions);
  for (std::uint32_t i = 0; i < kept->first.size(); ++i) kept->second.push_back(i);
  frame.keep(kept);
  frame.draw({.state = state,
              .mesh = {.positions = kept->first, .indices = kept->second},
              .stencil_ref = ref});
}

}  // namespace gnomon::small_frames
