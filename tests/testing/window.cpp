#include "testing/window.h"

#include <memory>

#include "raster/check.h"

namespace gnomon::testing {

namespace {

struct Shape {
  std::vector<glm::vec4> positions;
  std::vector<std::uint32_t> indices;
};

/// Appends the four corners, counter-clockwise from the bottom left one.
void append_corners(Shape& shape, const raster::Targets& targets, const raster::Rect& pixels,
                    float depth) {
  raster::require(depth >= 0.0f && depth <= 1.0f, "a depth lies in [0, 1]");
  const auto clip = [](std::int64_t pixel, int size) {
    return static_cast<float>(2.0 * static_cast<double>(pixel) / size - 1.0);
  };
  const float x0 = clip(pixels.x, targets.width()), y0 = clip(pixels.y, targets.height());
  const float x1 = clip(std::int64_t{pixels.x} + pixels.width, targets.width());
  const float y1 = clip(std::int64_t{pixels.y} + pixels.height, targets.height());
  const float z = 2.0f * depth - 1.0f;
  for (const glm::vec4& corner :
       {glm::vec4{x0, y0, z, 1}, {x1, y0, z, 1}, {x1, y1, z, 1}, {x0, y1, z, 1}})
    shape.positions.push_back(corner);
}

raster::Draw draw_of(raster::Frame& frame, const raster::State& state, Shape shape) {
  raster::require(!state.viewport && state.depth_range == raster::DepthRange{},
                  "a shape in window coordinates has the default viewport and depth range");
  auto kept = std::make_shared<const Shape>(std::move(shape));
  frame.keep(kept);
  return {.state = state, .mesh = {.positions = kept->positions, .indices = kept->indices}};
}

const raster::Targets& targets_of(const raster::Frame& frame) {
  raster::require(!frame.passes().empty(), "begin_pass comes before shapes");
  return frame.passes().back().targets;
}

}  // namespace

raster::Draw window_quad(raster::Frame& frame, const raster::State& state,
                         const raster::Rect& pixels, float depth) {
  Shape shape{{}, {0, 1, 2, 0, 2, 3}};
  append_corners(shape, targets_of(frame), pixels, depth);
  return draw_of(frame, state, std::move(shape));
}

raster::Draw window_box(raster::Frame& frame, const raster::State& state,
                        const raster::Rect& pixels, float near_depth, float far_depth) {
  Shape shape{{}, {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6}};
  append_corners(shape, targets_of(frame), pixels, near_depth);
  append_corners(shape, targets_of(frame), pixels, far_depth);
  return draw_of(frame, state, std::move(shape));
}

}  // namespace gnomon::testing
