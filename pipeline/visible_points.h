// The points of a scene that a camera sees, one a pixel, in double.
// The surface at a pixel - object and triangle - is the one that the rasterizer draws there: a pass
// like the methods' own, with depth LESS, whose colours are the triangles' numbers, is executed. So
// depth EQUAL later finds the same surface. The point is where the line through the pixel's centre
// meets that triangle, computed from its corners, and not from the stored depth: a unit of D24 is
// millimetres in the distance, a double is not.
// Invariant: the point lies on its triangle, up to `error_m` of its record. Where the line passes
// by it (corners snap to 1/256 pixel, so the triangle may cover a centre that it does not hold) the
// point is on its edge.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/placed_object.h"
#include "pipeline/scene.h"
#include "raster/buffers.h"
#include "raster/execute.h"

namespace gnomon::pipeline {

/// A mesh's corners in the world, one a position of its topology. Those of its triangles are
/// finite.
struct WorldCorners {
  std::vector<glm::dvec3> at;
  /// No coordinate of a triangle's corner is farther from where the transform, computed without
  /// rounding, takes it.
  double error_m = 0.0;
  /// What float32 tells apart there: surfaces that were made coplanar may lie so far apart.
  double apart_m = 0.0;
  /// Bounds of the triangles.
  glm::dvec3 low{0.0}, high{0.0};
};

void place_corners(const Topology& topology, const glm::mat4& world_from_model, int threads,
                   WorldCorners& corners);

struct VisiblePoint {
  static constexpr std::uint32_t kNone = 0xffffffff;
  /// On the visible side of the triangle, WorldCorners::apart_m before it: of coplanar surfaces the
  /// pixel may show the one that rounding has put behind.
  glm::dvec3 at{0.0};
  /// No coordinate of `at` is farther from there.
  double error_m = 0.0;
  /// Place among the objects; kNone where no surface is.
  std::uint32_t object = kNone;
  /// The triangle's corners among the object's WorldCorners.
  std::array<std::uint32_t, 3> corners{};
};

/// Finds the visible points, in memory that it keeps between frames. Not for use by several threads
/// at once.
class PointFinder {
 public:
  /// One a pixel of a target of that size and depth format, row after row from the bottom row, and
  /// one WorldCorners an object. Both are valid until the next call.
  /// Preconditions: `objects` are placed for `camera`; fewer than 65536 parts in all.
  void find(std::span<const PlacedObject> objects, const Camera& camera, int width, int height,
            raster::DepthFormat format, int threads);

  std::span<const VisiblePoint> points() const { return points_; }
  std::span<const WorldCorners> corners() const { return corners_; }

 private:
  struct NumberedModel {
    std::shared_ptr<const Model> model;
    /// One a part: each triangle with corners of its own, whose colour is its number.
    std::vector<std::shared_ptr<const Mesh>> parts;
  };
  /// A part of an object, and where its vertices begin among its model's.
  struct NumberedPart {
    std::uint32_t object = 0, part = 0, first_vertex = 0;
  };

  const NumberedModel& numbered(const std::shared_ptr<const Model>& model);
  void draw_numbers(std::span<const PlacedObject> objects, raster::DepthFormat format, int threads);
  VisiblePoint point_at(std::span<const PlacedObject> objects, const glm::dmat4& clip_from_world,
                        const glm::dvec4& eye, int x, int y) const;

  int width_ = 0, height_ = 0;
  std::vector<NumberedModel> models_;
  std::vector<NumberedPart> parts_;
  std::unique_ptr<raster::ColorBuffer> numbers_;
  std::unique_ptr<raster::DepthBuffer> depth_;
  raster::ExecuteMemory executing_;
  std::vector<WorldCorners> corners_;
  std::vector<VisiblePoint> points_;
};

/// The homogeneous point that all lines of sight of a camera come from: its eye (w > 0) or, in a
/// parallel projection, the direction towards the viewer (w = 0), up to a positive scale. Null for
/// a matrix without one.
glm::dvec4 eye_of(const glm::mat4& clip_from_world);

}  // namespace gnomon::pipeline
