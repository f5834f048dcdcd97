// Points that lie near a segment or a point, from a balanced tree of boxes.
// Invariant: what is found does not depend on how the tree was built; it comes in ascending order.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace gnomon::pipeline {

class PointTree {
 public:
  /// Precondition: every point is finite.
  explicit PointTree(std::vector<glm::dvec3> points);

  /// The numbers of all points at most `radius` from the segment (the point, where both ends are
  /// one), ascending.
  std::vector<std::uint32_t> near_segment(const glm::dvec3& a, const glm::dvec3& b,
                                          double radius) const;

 private:
  /// Order [begin, end) and the box around its points; a leaf has no children.
  struct Node {
    std::uint32_t begin = 0, end = 0, right = 0;
    glm::dvec3 low{0.0}, high{0.0};
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end);

  std::vector<glm::dvec3> points_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

/// The point of segment a-b that is closest to p, as its share of the way from a to b (0 to 1).
double closest_on_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b);

}  // namespace gnomon::pipeline
