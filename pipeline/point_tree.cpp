#include "pipeline/point_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace gnomon::pipeline {
namespace {

constexpr std::uint32_t kLeafPoints = 8;

/// May the segment come into the box? Clips it by the three slabs.
bool touches(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& a,
             const glm::dvec3& b) {
  double enter = 0.0, leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = b[axis] - a[axis];
    if (way == 0.0) {
      if (a[axis] < low[axis] || a[axis] > high[axis]) return false;
      continue;
    }
    double first = (low[axis] - a[axis]) / way, second = (high[axis] - a[axis]) / way;
    if (first > second) std::swap(first, second);
    enter = std::max(enter, first);
    leave = std::min(leave, second);
  }
  // A little more than the clipping's own rounding.
  return enter <= leave + 1e-9;
}

}  // namespace

double closest_on_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 way = b - a;
  const double length2 = glm::dot(way, way);
  return length2 > 0.0 ? std::clamp(glm::dot(p - a, way) / length2, 0.0, 1.0) : 0.0;
}

PointTree::PointTree(std::vector<glm::dvec3> points) : points_(std::move(points)) {
  order_.resize(points_.size());
  std::iota(order_.begin(), order_.end(), std::uint32_t{0});
  if (!points_.empty()) build(0, static_cast<std::uint32_t>(points_.size()));
}

std::uint32_t PointTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  Node node{.begin = begin, .end = end};
  node.low = node.high = points_[order_[begin]];
  for (std::uint32_t i = begin; i < end; ++i) {
    node.low = glm::min(node.low, points_[order_[i]]);
    node.high = glm::max(node.high, points_[order_[i]]);
  }
  nodes_.push_back(node);
  if (end - begin > kLeafPoints) {
    const glm::dvec3 size = node.high - node.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return points_[a][axis] < points_[b][axis] ||
                              (points_[a][axis] == points_[b][axis] && a < b);
                     });
    build(begin, middle);
    nodes_[number].right = build(middle, end);
  }
  return number;
}

std::vector<std::uint32_t> PointTree::near_segment(const glm::dvec3& a, const glm::dvec3& b,
                                                   double radius) const {
  std::vector<std::uint32_t> found;
  if (nodes_.empty()) return found;
  std::vector<std::uint32_t> waiting{0};
  while (!waiting.empty()) {
    const std::uint32_t number = waiting.back();
    waiting.pop_back();
    const Node& node = nodes_[number];
    if (!touches(node.low - radius, node.high + radius, a, b)) continue;
    if (node.right != 0) {
      waiting.push_back(node.right);
      waiting.push_back(number + 1);
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const glm::dvec3& p = points_[order_[i]];
      const double share = closest_on_segment(p, a, b);
      if (glm::distance(p, a + share * (b - a)) <= radius) found.push_back(order_[i]);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace gnomon::pipeline
