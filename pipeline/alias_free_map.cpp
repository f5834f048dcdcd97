// The depth test's bound. V = dot(cross(e, f), q), with e = b - a, f = c - a and q = p - a, is
// twice the triangle's area times the point's distance from its plane. Rounded, it is off by at
// most 18 u m |q| (pipeline/plane_side.cpp), with m = largest_minor(e, f), u = kRounding and sums
// of sizes for |.|. And the point and the corners are where they are up to t, the sum of their
// errors in metres: e, f and q move by at most 2 t each, so V moves by less than 2 t (|e| + |f|)
// |q| for the normal and 6 t m for q, and terms with t^2, for which everything is taken twice. A
// point with V inside that bound may lie on the plane, or in front of it. One beyond it lies
// behind, whatever was rounded.
//
// Of a closed mesh, the triangles turned from the light are enough where light and eye are outside.
// Along a line the mesh's winding number grows by one where it enters and falls by one where it
// leaves; it is 0 at the eye, so at the visible point and just before its surface, and 0 at the
// light. So a line between the two that crosses the mesh leaves it as often as it enters. (A light
// on the other side of the point's surface is another matter: a surface turned from the light.) A
// mesh that casts in the place of one that is drawn stops no line of sight: a visible point may be
// in it, so all of its triangles are taken.
#include "pipeline/alias_free_map.h"

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "pipeline/plane_side.h"
#include "pipeline/silhouette.h"
#include "raster/check.h"
#include "raster/clip.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

/// Triangles, and points, that one piece of work takes.
constexpr std::size_t kTriangles = 256, kPoints = 4096;

double sum_of_sizes(const glm::dvec3& p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z); }

/// A triangle that turns counter-clockwise, seen from the light; what of its tests is the same for
/// all points.
class CasterTriangle {
 public:
  CasterTriangle(const std::array<glm::dvec3, 3>& corners, double error_m, const glm::dvec4& light)
      : corners_(corners), light_(light) {
    const glm::dvec3 e = corners[1] - corners[0], f = corners[2] - corners[0];
    normal_ = glm::cross(e, f);
    const double minor = largest_minor(e, f);
    rounding_ = 18.0 * kRounding * minor;
    reach_ = 4.0 * (sum_of_sizes(e) + sum_of_sizes(f));
    thickness_ = 12.0 * minor;
    error_m_ = error_m;
    for (std::size_t i = 0; i < 3; ++i) edges_[i] = edge(corners[i], corners[(i + 1) % 3]);
  }

  /// Does it cross the line from the point to the light?
  bool hides(const glm::dvec3& p, double point_error_m) const {
    const glm::dvec3 q = p - corners_[0];
    const double size = sum_of_sizes(q), error_m = error_m_ + point_error_m;
    const double bound = size * (rounding_ + error_m * reach_) + error_m * thickness_;
    if (!(glm::dot(normal_, q) < -bound)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!inside(i, p)) return false;
    }
    return true;
  }

 private:
  /// The plane through an edge and the light: the inner points have dot(normal, p - origin) >= 0,
  /// as det(from - p, to - p, light - w p) is.
  struct EdgePlane {
    glm::dvec3 normal, origin;
    double rounding;
  };

  EdgePlane edge(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 light(light_);
    const bool is_point = light_.w != 0.0;
    const glm::dvec3 first = is_point ? to - light : light;
    const glm::dvec3 second = is_point ? from - light : to - from;
    return {glm::cross(first, second), is_point ? light : from,
            18.0 * kRounding * largest_minor(first, second)};
  }

  bool inside(std::size_t i, const glm::dvec3& p) const {
    const EdgePlane& edge = edges_[i];
    const glm::dvec3 q = p - edge.origin;
    const double value = glm::dot(edge.normal, q), bound = edge.rounding * sum_of_sizes(q);
    if (value > bound) return true;
    if (value < -bound) return false;
    return side_of_plane(p, corners_[i], corners_[(i + 1) % 3], light_) >= 0;
  }

  std::array<glm::dvec3, 3> corners_;
  glm::dvec4 light_;
  glm::dvec3 normal_{0.0};
  double rounding_ = 0.0, reach_ = 0.0, thickness_ = 0.0, error_m_ = 0.0;
  std::array<EdgePlane, 3> edges_;
};

bool outside_bounds(const WorldCorners& corners, const glm::dvec4& light) {
  if (light.w == 0.0) return true;
  for (int i = 0; i < 3; ++i) {
    if (light[i] < corners.low[i] || light[i] > corners.high[i]) return true;
  }
  return false;
}

/// Is everything, or nothing, of the mesh's bounds beyond where lines of sight begin?
bool clear_of_the_eye(const WorldCorners& corners, const Camera& camera) {
  const glm::dvec4 w = glm::transpose(glm::dmat4(camera.clip_from_world))[3];
  double low = w.w, high = w.w;
  for (int i = 0; i < 3; ++i) {
    low += std::min(w[i] * corners.low[i], w[i] * corners.high[i]);
    high += std::max(w[i] * corners.low[i], w[i] * corners.high[i]);
  }
  return low > raster::kMinW || high < raster::kMinW;
}

/// Which of an object's triangles are tested.
struct Caster {
  const PlacedObject* object = nullptr;
  const WorldCorners* corners = nullptr;
  /// Only those that this side of is towards the light: 1 or -1; 0: all.
  int side = 0;
};

/// So many of a caster's triangles.
struct TrianglePiece {
  std::size_t caster = 0, first = 0, last = 0;
};

/// A triangle and some of the points in the cells that it covers.
struct TestPiece {
  CasterTriangle triangle;
  PointRange range;
};

class HiddenPoints {
 public:
  HiddenPoints(std::span<const PlacedObject> objects, const Casters& casters, const Camera& camera,
               const Light& light, int threads, AliasFreeMemory& memory)
      : objects_(objects),
        casting_(casters),
        light_(light.position),
        threads_(threads),
        memory_(memory) {
    memory.shadow_corners.resize(objects.size());
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (!casters.contains(*objects[i].object)) continue;
      if (!objects[i].object->casts_as_drawn())
        place_corners(caster_for(objects[i], light.position, memory.moved),
                      objects[i].object->world_from_model, threads, memory.shadow_corners[i]);
      const WorldCorners& corners = objects[i].object->casts_as_drawn() ? memory.finder.corners()[i]
                                                                        : memory.shadow_corners[i];
      const bool one_side = objects[i].object->casts_as_drawn() && objects[i].topology->closed() &&
                            outside_bounds(corners, light_) && clear_of_the_eye(corners, camera);
      const glm::dmat3 world(glm::dmat4(objects[i].object->world_from_model));
      const int away = glm::determinant(world) < 0.0 ? 1 : -1;
      casters_.push_back({&objects[i], &corners, one_side ? away : 0});
    }
    eye_ = eye_of(camera.clip_from_world);
  }

  void find() {
    take_points();
    memory_.grid.build(memory_.points, glm::vec4(light_), threads_);
    sort_points();
    test_triangles();
    const std::span<const std::uint32_t> order = memory_.grid.order();
    for (std::size_t i = 0; i < order.size(); ++i)
      memory_.hidden[memory_.pixels[order[i]]] =
          memory_.sorted_hidden[i].load(std::memory_order_relaxed);
  }

 private:
  /// Fills memory_.hidden with what surfaces hide of themselves, and the points that are left.
  void take_points() {
    const std::span<const VisiblePoint> points = memory_.finder.points();
    memory_.hidden.resize(points.size());
    raster::for_each_chunk(points.size(), kPoints, threads_,
                           [&](std::size_t first, std::size_t last) {
                             for (std::size_t i = first; i < last; ++i)
                               memory_.hidden[i] = is_turned_away(points[i]) ? 1 : 0;
                           });
    memory_.pixels.clear();
    memory_.points.clear();
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const VisiblePoint& point = points[i];
      if (point.object == VisiblePoint::kNone || memory_.hidden[i] != 0) continue;
      if (!objects_[point.object].object->receives) continue;
      memory_.pixels.push_back(i);
      memory_.points.push_back(point.at);
    }
  }

  /// Is it of a caster's surface, seen from the side that is turned from the light?
  bool is_turned_away(const VisiblePoint& point) const {
    if (point.object == VisiblePoint::kNone) return false;
    const Object& object = *objects_[point.object].object;
    if (!casting_.contains(object) || !object.casts_as_drawn() || !object.receives) return false;
    const std::vector<glm::dvec3>& at = memory_.finder.corners()[point.object].at;
    const glm::dvec3 &a = at[point.corners[0]], &b = at[point.corners[1]],
                     &c = at[point.corners[2]];
    const double seen = glm::dot(glm::cross(b - a, c - a), glm::dvec3(eye_) - a * eye_.w);
    const int lit = side_of_plane(a, b, c, light_);
    return seen > 0.0 ? lit <= 0 : lit >= 0;
  }

  void sort_points() {
    const std::span<const std::uint32_t> order = memory_.grid.order();
    memory_.sorted.resize(order.size());
    if (memory_.sorted_hidden.size() < order.size())
      memory_.sorted_hidden = std::vector<std::atomic<std::uint8_t>>(order.size());
    const std::span<const VisiblePoint> points = memory_.finder.points();
    raster::for_each_chunk(order.size(), kPoints, threads_,
                           [&](std::size_t first, std::size_t last) {
                             for (std::size_t i = first; i < last; ++i) {
                               const VisiblePoint& point = points[memory_.pixels[order[i]]];
                               memory_.sorted[i] = {point.at, point.error_m};
                               memory_.sorted_hidden[i].store(0, std::memory_order_relaxed);
                             }
                           });
  }

  /// Triangles that cover few points are tested where they are found; the others' points are cut in
  /// pieces, so that one plate's two triangles are work for all threads.
  void test_triangles() {
    std::vector<TrianglePiece> pieces;
    for (std::size_t i = 0; i < casters_.size(); ++i) {
      const std::size_t count = casters_[i].object->caster_topology->triangle_count();
      for (std::size_t first = 0; first < count; first += kTriangles)
        pieces.push_back({i, first, std::min(count, first + kTriangles)});
    }
    std::vector<std::vector<TestPiece>> large(pieces.size());
    raster::for_each_chunk(pieces.size(), 1, threads_, [&](std::size_t first, std::size_t) {
      test_piece(pieces[first], large[first]);
    });
    std::vector<TestPiece> rest;
    for (const std::vector<TestPiece>& some : large)
      rest.insert(rest.end(), some.begin(), some.end());
    raster::for_each_chunk(rest.size(), 1, threads_, [&](std::size_t first, std::size_t) {
      test(rest[first].triangle, rest[first].range);
    });
  }

  void test_piece(const TrianglePiece& piece, std::vector<TestPiece>& large) {
    const Caster& caster = casters_[piece.caster];
    const std::vector<std::uint32_t>& indices = caster.object->caster_topology->indices;
    std::vector<PointRange> ranges;
    for (std::size_t t = piece.first; t < piece.last; ++t) {
      std::array<glm::dvec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = caster.corners->at[indices[3 * t + k]];
      const int side = side_of_plane(corners[0], corners[1], corners[2], light_);
      if (side == 0 || (caster.side != 0 && side != caster.side)) continue;
      if (side < 0) std::swap(corners[1], corners[2]);
      ranges.clear();
      memory_.grid.covers(corners, ranges);
      if (ranges.empty()) continue;
      const CasterTriangle triangle(corners, caster.corners->error_m, light_);
      std::size_t points = 0;
      for (const PointRange& range : ranges) points += range.last - range.first;
      if (points < kPoints)
        for (const PointRange& range : ranges) test(triangle, range);
      else
        add_pieces(triangle, ranges, large);
    }
  }

  static void add_pieces(const CasterTriangle& triangle, std::span<const PointRange> ranges,
                         std::vector<TestPiece>& pieces) {
    for (PointRange range : ranges) {
      for (; range.last - range.first > kPoints; range.first += kPoints)
        pieces.push_back({triangle, {range.first, range.first + std::uint32_t{kPoints}}});
      pieces.push_back({triangle, range});
    }
  }

  /// Any number of threads may hide a point; none sees it lit again.
  void test(const CasterTriangle& triangle, const PointRange& range) {
    for (std::size_t i = range.first; i < range.last; ++i) {
      std::atomic<std::uint8_t>& hidden = memory_.sorted_hidden[i];
      if (hidden.load(std::memory_order_relaxed) != 0) continue;
      const AliasFreeMemory::TestPoint& point = memory_.sorted[i];
      if (triangle.hides(point.at, point.error_m)) hidden.store(1, std::memory_order_relaxed);
    }
  }

  std::span<const PlacedObject> objects_;
  const Casters& casting_;
  glm::dvec4 light_, eye_{0.0};
  int threads_;
  AliasFreeMemory& memory_;
  std::vector<Caster> casters_;
};

struct Rectangles {
  std::vector<glm::vec4> positions;
  std::vector<std::uint32_t> indices;

  /// Pixels [first, last) of a row.
  void add(int first, int last, int row, int width, int height) {
    const auto base = static_cast<std::uint32_t>(positions.size());
    // A whole number of pixels comes out of float32 and the snap as it went in.
    const auto at = [](int edge, int size) { return static_cast<float>(2.0 * edge / size - 1.0); };
    const float left = at(first, width), right = at(last, width);
    const float bottom = at(row, height), top = at(row + 1, height);
    positions.insert(positions.end(), {{left, bottom, 0.0f, 1.0f},
                                       {right, bottom, 0.0f, 1.0f},
                                       {right, top, 0.0f, 1.0f},
                                       {left, top, 0.0f, 1.0f}});
    indices.insert(indices.end(), {base, base + 1, base + 2, base, base + 2, base + 3});
  }
};

}  // namespace

std::span<const std::uint8_t> find_hidden(std::span<const PlacedObject> objects,
                                          const Casters& casters, const Camera& camera,
                                          const Light& light, int threads,
                                          AliasFreeMemory& memory) {
  // The same rules as for volumes.
  (void)light_in_model(light.position, glm::mat4(1.0f));
  raster::require(memory.finder.corners().size() == objects.size(),
                  "the visible points are those of the objects");
  HiddenPoints(objects, casters, camera, light, threads, memory).find();
  return memory.hidden;
}

void stencil_hidden(raster::Frame& frame, std::span<const std::uint8_t> hidden, int width,
                    int height, std::string label) {
  raster::require(
      hidden.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
      "a mask has one byte a pixel");
  const auto rectangles = std::make_shared<Rectangles>();
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* row =
        &hidden[static_cast<std::size_t>(y) * static_cast<std::size_t>(width)];
    for (int x = 0; x < width; ++x) {
      if (row[x] == 0) continue;
      const int first = x;
      while (x < width && row[x] != 0) ++x;
      rectangles->add(first, x, y, width, height);
    }
  }
  frame.keep(rectangles);
  raster::Draw draw;
  draw.state = surface_state();
  draw.state.color = raster::ColorState::off();
  draw.state.stencil = raster::StencilState::both({.pass = raster::StencilOp::incr});
  draw.mesh = {.positions = rectangles->positions, .indices = rectangles->indices};
  draw.label = std::move(label);
  frame.draw(std::move(draw));
}

}  // namespace gnomon::pipeline
