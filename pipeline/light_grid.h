// Points sorted into the cells of a light's view, and the cells that a triangle covers there: the
// irregular Z-buffer (Johnson, Lee, Burns and Mark 2005; Aila and Laine 2004).
// A point light's view is six faces about it, the points' largest coordinate says which; a
// direction's is one plane, along it. On each face the rectangle that its points span is cut into
// about as many cells as it has points.
// Invariant: a range that covers() leaves out holds no point for which the triangle lies on the
// line to the light. What a range holds is only a candidate. light_grid.cpp has the proof.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace gnomon::pipeline {

/// Places in LightGrid::order().
struct PointRange {
  std::uint32_t first = 0, last = 0;
};

/// Keeps its memory between lights. Not for build() by several threads at once; the rest is const.
class LightGrid {
 public:
  /// Sorts the points; `light` as Light::position. A point that the light is at, or that is not
  /// finite, is in no range.
  void build(std::span<const glm::dvec3> points, const glm::vec4& light, int threads);

  /// The points' numbers, cell after cell, within a cell ascending.
  std::span<const std::uint32_t> order() const { return order_; }

  /// Appends the ranges of points that the triangle may hide. Precondition: finite corners.
  void covers(const std::array<glm::dvec3, 3>& triangle, std::vector<PointRange>& ranges) const;

 private:
  static constexpr std::size_t kFaces = 6;

  /// A part of the light's view: places (X / W, Y / W) of homogeneous (X, Y, W).
  struct Face {
    /// The coordinate that W is, up to `sign`; a direction's W is 1.
    int axis = 2;
    double sign = 1.0;
    /// How far X and Y move a unit of the coordinate, along a direction.
    glm::dvec2 shear{0.0};
    /// Of its points: how many, their largest coordinate, the rectangle of their places.
    std::size_t count = 0;
    double largest = 0.0;
    glm::dvec2 low{0.0}, high{0.0};
    /// Cells a unit of place.
    glm::dvec2 scale{1.0};
    int side = 0;
    std::uint32_t first_cell = 0;
  };

  glm::dvec3 homogeneous(const Face& face, const glm::dvec3& p) const;
  /// kFaces for a point that has no face.
  std::size_t face_of(const glm::dvec3& p) const;
  void choose_faces(const glm::vec4& light);
  void bound_points(std::span<const glm::dvec3> points, int threads);
  void set_cells();
  void sort_points(std::span<const glm::dvec3> points, int threads);
  bool is_near(const std::array<glm::dvec3, 3>& triangle) const;
  void cover(const Face& face, const std::array<glm::dvec3, 3>& triangle,
             std::vector<PointRange>& ranges) const;
  void add_range(const Face& face, int row, int first, int last,
                 std::vector<PointRange>& ranges) const;
  void add_rows(const Face& face, std::span<const glm::dvec2> polygon, glm::dvec2 pad,
                std::vector<PointRange>& ranges) const;

  bool is_point_ = true;
  glm::dvec3 light_{0.0};
  std::array<Face, kFaces> faces_;
  std::size_t face_count_ = 0;
  /// One a point: its face, then its cell; of a point without a face the one after the last.
  std::vector<std::uint32_t> cells_;
  /// Where each cell's points begin, and where the last one's end.
  std::vector<std::uint32_t> starts_;
  std::vector<std::uint32_t> order_;
};

}  // namespace gnomon::pipeline
