#include "raster/clip.h"

#include <algorithm>

namespace gnomon::raster {

namespace {

constexpr int kPlanes = 7;

/// Signed distance (not normalised) to plane 0 to 6: w, near, far, left, right, bottom, top. Not
/// negative is inside.
double distance(const glm::dvec4& p, int plane, const ClipVolume& volume) {
  switch (plane) {
    case 0:
      return p.w - kMinW;
    case 1:
      return p.w + p.z;
    case 2:
      return p.w - p.z;
    case 3:
      return volume.guard_x * p.w + p.x;
    case 4:
      return volume.guard_x * p.w - p.x;
    case 5:
      return volume.guard_y * p.w + p.y;
    default:
      return volume.guard_y * p.w - p.y;
  }
}

bool skipped(int plane, const ClipVolume& volume) {
  return !volume.near_and_far && (plane == 1 || plane == 2);
}

ClipVertex cut(const ClipVertex& inner, double inner_distance, const ClipVertex& outer,
               double outer_distance) {
  const double t = inner_distance / (inner_distance - outer_distance);
  ClipVertex vertex{inner.position + (outer.position - inner.position) * t,
                    inner.weights + (outer.weights - inner.weights) * t};
  // Where one end's w is 2^50 times the other's, the difference rounds the small one away.
  vertex.position.w = std::max(vertex.position.w, kMinW);
  return vertex;
}

ClippedPolygon clip_plane(const ClippedPolygon& in, int plane, const ClipVolume& volume) {
  ClippedPolygon out;
  for (int i = 0; i < in.count; ++i) {
    const ClipVertex& a = in.vertices[static_cast<std::size_t>(i)];
    const ClipVertex& b = in.vertices[static_cast<std::size_t>((i + 1) % in.count)];
    const double da = distance(a.position, plane, volume);
    const double db = distance(b.position, plane, volume);
    // A convex polygon has room for every plane; one that rounding has bent may cross a plane more
    // than twice, and what has no room then is smaller than that rounding.
    const auto emit = [&out](const ClipVertex& v) {
      const auto slot = static_cast<std::size_t>(out.count);
      if (slot == out.vertices.size()) return;
      out.vertices[slot] = v;
      ++out.count;
    };
    if (da >= 0.0) emit(a);
    if (da >= 0.0 && db < 0.0) emit(cut(a, da, b, db));
    if (da < 0.0 && db >= 0.0) emit(cut(b, db, a, da));
  }
  return out;
}

}  // namespace

bool ClipVolume::contains(const glm::vec4& position) const {
  for (int plane = 0; plane < kPlanes; ++plane)
    if (!skipped(plane, *this) && !(distance(position, plane, *this) >= 0.0)) return false;
  return true;
}

ClippedPolygon clip_triangle(const std::array<glm::vec4, 3>& triangle, const ClipVolume& volume) {
  ClippedPolygon polygon;
  polygon.count = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    glm::dvec3 weights(0.0);
    weights[static_cast<int>(i)] = 1.0;
    polygon.vertices[i] = {glm::dvec4(triangle[i]), weights};
  }
  for (int plane = 0; plane < kPlanes && polygon.count > 0; ++plane)
    if (!skipped(plane, volume)) polygon = clip_plane(polygon, plane, volume);
  if (polygon.count < 3) polygon.count = 0;
  return polygon;
}

}  // namespace gnomon::raster
