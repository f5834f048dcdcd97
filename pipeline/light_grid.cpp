// Why no point is missed. A point and the place where the line from it to the light meets a
// triangle have one place on the face, if nothing rounds; so the triangle's outline on the face,
// cut to the points' rectangle, holds the point's place. What rounds, with u = kRounding:
// - A point light. Differences from the light are off by u of themselves, places, quotients of two
//   of them, by 3 u, for they are at most 1 on a face. Cutting adds u of the triangle's largest
//   coordinate S (from the light) a cut, over W. A triangle whose plane passes within 2^-20 S of
//   the light is taken to cover everything (is_near); of others every point is farther from the
//   light than that, so on a face its W is at least 2^-21 S, and four cuts move a place by less
//   than 16 u 2^21 < 2^-27.
// - A direction. Places are differences of two coordinates of at most M, off by 4 u M, cut or not.
// kPad of a cell and the above are added on all sides of the outline. A cut that leaves a sliver
// out, for rounding, leaves out less than that of the rectangle's edge, and points keep kMargin of
// the rectangle away from its edge. Rows are bounded by crossings of their padded bounds, which lie
// beyond those of their own bounds by the slope times the pad; that is more than rounding moves
// them.
#include "pipeline/light_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/finite.h"
#include "pipeline/plane_side.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Points that one piece of work takes.
constexpr std::size_t kChunk = 8192;
/// Cells a side of a face at most.
constexpr int kLargestSide = 4096;
/// Of a cell, and of a rectangle.
constexpr double kPad = 1.0 / 256.0, kMargin = 1.0 / 1024.0;
/// The smallest side of a rectangle; of a direction's times the largest coordinate.
constexpr double kSmallest = 0x1p-30;
/// What places on a point light's face, of a point and of a triangle, are off by together.
constexpr double kUncut = 8.0 * kRounding, kCut = 0x1p-26;

double largest(const glm::dvec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// A triangle cut to four planes. One more corner a plane if nothing rounds; where corners lie
/// along a plane rounding may make half as many again: 4, 6, 9, 13.
struct CutTriangle {
  std::array<glm::dvec3, 13> corners;
  std::size_t count = 3;
  bool cut = false;
};

/// Leaves what is not below 0 of distance(corner).
template <class Distance>
void cut(CutTriangle& polygon, Distance distance) {
  std::array<double, 13> at;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    at[i] = distance(polygon.corners[i]);
    inside += at[i] >= 0.0;
  }
  if (inside == polygon.count) return;
  const CutTriangle whole = polygon;
  polygon.cut = true;
  polygon.count = 0;
  if (inside == 0) return;
  for (std::size_t i = 0; i < whole.count; ++i) {
    const std::size_t next = i + 1 == whole.count ? 0 : i + 1;
    const glm::dvec3 &p = whole.corners[i], &q = whole.corners[next];
    if (at[i] >= 0.0) polygon.corners[polygon.count++] = p;
    if ((at[i] >= 0.0) != (at[next] >= 0.0))
      polygon.corners[polygon.count++] = p + (q - p) * (at[i] / (at[i] - at[next]));
  }
}

struct Bounds {
  glm::dvec2 low{kInfinity}, high{-kInfinity};
  void add(const glm::dvec2& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

/// The x that the part of a polygon between two heights spans.
Bounds part_between(std::span<const glm::dvec2> polygon, double low, double high) {
  Bounds part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 p = polygon[i], q = polygon[i + 1 == polygon.size() ? 0 : i + 1];
    if (p.y >= low && p.y <= high) part.add(p);
    for (const double y : {low, high}) {
      if ((p.y < y) == (q.y < y)) continue;
      part.add({p.x + (q.x - p.x) * ((y - p.y) / (q.y - p.y)), y});
    }
  }
  return part;
}

int cell_at(double place, int side) {
  return place >= side ? side - 1 : place > 0.0 ? static_cast<int>(place) : 0;
}

}  // namespace

glm::dvec3 LightGrid::homogeneous(const Face& face, const glm::dvec3& p) const {
  const int x = (face.axis + 1) % 3, y = (face.axis + 2) % 3;
  if (!is_point_)
    return {p[x] - p[face.axis] * face.shear.x, p[y] - p[face.axis] * face.shear.y, 1.0};
  const glm::dvec3 q = p - light_;
  return {q[x], q[y], q[face.axis] * face.sign};
}

std::size_t LightGrid::face_of(const glm::dvec3& p) const {
  if (!is_finite(p)) return kFaces;
  if (!is_point_) return 0;
  const glm::dvec3 q = p - light_, size = glm::abs(q);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  if (size[axis] == 0.0) return kFaces;
  return static_cast<std::size_t>(2 * axis + (q[axis] < 0.0));
}

void LightGrid::choose_faces(const glm::vec4& light) {
  is_point_ = light.w != 0.0f;
  light_ = glm::dvec3(light);
  face_count_ = is_point_ ? kFaces : 1;
  for (std::size_t i = 0; i < face_count_; ++i) {
    faces_[i] = Face{};
    faces_[i].axis = static_cast<int>(i / 2);
    faces_[i].sign = i % 2 ? -1.0 : 1.0;
  }
  if (is_point_) return;
  const glm::dvec3 size = glm::abs(light_);
  Face& face = faces_[0];
  face.axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  face.shear =
      glm::dvec2(light_[(face.axis + 1) % 3], light_[(face.axis + 2) % 3]) / light_[face.axis];
}

void LightGrid::bound_points(std::span<const glm::dvec3> points, int threads) {
  struct Part {
    std::array<Bounds, kFaces> bounds;
    std::array<std::size_t, kFaces> counts{};
    double largest = 0.0;
  };
  std::vector<Part> parts((points.size() + kChunk - 1) / kChunk);
  cells_.resize(points.size());
  raster::for_each_chunk(points.size(), kChunk, threads, [&](std::size_t first, std::size_t last) {
    Part& part = parts[first / kChunk];
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t face = face_of(points[i]);
      cells_[i] = static_cast<std::uint32_t>(face);
      if (face == kFaces) continue;
      const glm::dvec3 p = homogeneous(faces_[face], points[i]);
      part.bounds[face].add(glm::dvec2(p) / p.z);
      ++part.counts[face];
      part.largest = std::max(part.largest, largest(points[i]));
    }
  });
  for (std::size_t f = 0; f < face_count_; ++f) {
    Bounds bounds;
    for (const Part& part : parts) {
      if (part.counts[f] == 0) continue;
      bounds.add(part.bounds[f].low);
      bounds.add(part.bounds[f].high);
      faces_[f].count += part.counts[f];
      faces_[f].largest = std::max(faces_[f].largest, part.largest);
    }
    faces_[f].low = bounds.low;
    faces_[f].high = bounds.high;
  }
}

void LightGrid::set_cells() {
  std::uint32_t cells = 0;
  for (Face& face : std::span(faces_).first(face_count_)) {
    face.first_cell = cells;
    face.side = 0;
    if (face.count == 0) continue;
    face.side =
        std::min(kLargestSide, static_cast<int>(std::sqrt(static_cast<double>(face.count))) + 1);
    // A direction's places may all be 0.
    const double smallest = is_point_ ? kSmallest : kSmallest * std::max(face.largest, kSmallest);
    const glm::dvec2 extent =
        glm::max(face.high - face.low, glm::dvec2(smallest)) * (1.0 + 2.0 * kMargin);
    const glm::dvec2 middle = (face.low + face.high) * 0.5;
    face.low = middle - extent * 0.5;
    face.high = middle + extent * 0.5;
    face.scale = static_cast<double>(face.side) / extent;
    cells += static_cast<std::uint32_t>(face.side * face.side);
  }
  // One more for points without a face.
  starts_.assign(cells + 2, 0);
}

void LightGrid::sort_points(std::span<const glm::dvec3> points, int threads) {
  const auto none = static_cast<std::uint32_t>(starts_.size() - 2);
  raster::for_each_chunk(points.size(), kChunk, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (cells_[i] == kFaces) {
        cells_[i] = none;
        continue;
      }
      const Face& face = faces_[cells_[i]];
      const glm::dvec3 p = homogeneous(face, points[i]);
      const glm::dvec2 place = (glm::dvec2(p) / p.z - face.low) * face.scale;
      const int column = cell_at(place.x, face.side), row = cell_at(place.y, face.side);
      cells_[i] = face.first_cell + static_cast<std::uint32_t>(row * face.side + column);
    }
  });
  for (const std::uint32_t cell : cells_) ++starts_[cell];
  std::uint32_t sum = 0;
  for (std::uint32_t& start : starts_) sum += std::exchange(start, sum);
  order_.resize(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) order_[starts_[cells_[i]]++] = i;
  // Each start has become its cell's end, which is the next one's start.
  std::copy_backward(starts_.begin(), starts_.end() - 1, starts_.end());
  starts_.front() = 0;
  order_.resize(starts_[none]);
}

void LightGrid::build(std::span<const glm::dvec3> points, const glm::vec4& light, int threads) {
  choose_faces(light);
  bound_points(points, threads);
  set_cells();
  sort_points(points, threads);
}

bool LightGrid::is_near(const std::array<glm::dvec3, 3>& triangle) const {
  const glm::dvec3 e = triangle[1] - triangle[0], f = triangle[2] - triangle[0];
  const glm::dvec3 normal = glm::cross(e, f), at = triangle[0] - light_;
  const double size =
      std::max({largest(at), largest(triangle[1] - light_), largest(triangle[2] - light_)});
  const double rounding = 64.0 * kRounding * largest_minor(e, f) * size;
  return !(std::abs(glm::dot(normal, at)) > 0x1p-20 * size * glm::length(normal) + rounding);
}

void LightGrid::add_range(const Face& face, int row, int first, int last,
                          std::vector<PointRange>& ranges) const {
  const std::size_t cell = face.first_cell + static_cast<std::size_t>(row * face.side);
  const std::uint32_t begin = starts_[cell + static_cast<std::size_t>(first)];
  const std::uint32_t end = starts_[cell + static_cast<std::size_t>(last) + 1];
  if (begin != end) ranges.push_back({begin, end});
}

void LightGrid::add_rows(const Face& face, std::span<const glm::dvec2> polygon, glm::dvec2 pad,
                         std::vector<PointRange>& ranges) const {
  Bounds bounds;
  for (const glm::dvec2& p : polygon) bounds.add(p);
  const int first_row = cell_at(bounds.low.y - pad.y, face.side);
  const int last_row = cell_at(bounds.high.y + pad.y, face.side);
  for (int row = first_row; row <= last_row; ++row) {
    const Bounds part =
        first_row == last_row ? bounds : part_between(polygon, row - pad.y, row + 1.0 + pad.y);
    if (part.low.x > part.high.x) continue;
    add_range(face, row, cell_at(part.low.x - pad.x, face.side),
              cell_at(part.high.x + pad.x, face.side), ranges);
  }
}

void LightGrid::cover(const Face& face, const std::array<glm::dvec3, 3>& triangle,
                      std::vector<PointRange>& ranges) const {
  CutTriangle polygon;
  for (std::size_t i = 0; i < 3; ++i) polygon.corners[i] = homogeneous(face, triangle[i]);
  cut(polygon, [&](const glm::dvec3& p) { return p.x - face.low.x * p.z; });
  cut(polygon, [&](const glm::dvec3& p) { return face.high.x * p.z - p.x; });
  cut(polygon, [&](const glm::dvec3& p) { return p.y - face.low.y * p.z; });
  cut(polygon, [&](const glm::dvec3& p) { return face.high.y * p.z - p.y; });
  if (polygon.count == 0) return;
  double off = polygon.cut ? kCut : kUncut;
  if (!is_point_) {
    const double coordinates =
        std::max({largest(triangle[0]), largest(triangle[1]), largest(triangle[2])});
    off = 4.0 * kRounding * (coordinates + face.largest);
  }
  std::array<glm::dvec2, 13> places;
  for (std::size_t i = 0; i < polygon.count; ++i)
    places[i] = (glm::dvec2(polygon.corners[i]) / polygon.corners[i].z - face.low) * face.scale;
  add_rows(face, std::span(places).first(polygon.count), kPad + face.scale * off, ranges);
}

void LightGrid::covers(const std::array<glm::dvec3, 3>& triangle,
                       std::vector<PointRange>& ranges) const {
  if (is_point_ && is_near(triangle)) {
    if (!order_.empty()) ranges.push_back({0, static_cast<std::uint32_t>(order_.size())});
    return;
  }
  for (const Face& face : std::span(faces_).first(face_count_)) {
    if (face.count > 0) cover(face, triangle, ranges);
  }
}

}  // namespace gnomon::pipeline
