#include "raster/project.h"

#include <algorithm>
#include <cmath>

#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

std::int32_t snap(double window) {
  constexpr double kLimit = kMaxCoordinate;
  return static_cast<std::int32_t>(round_to_nearest(std::clamp(window * 256.0, -kLimit, kLimit)));
}

}  // namespace

bool finite(const glm::vec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

ProjectedVertex project(const glm::dvec4& clip, const Projection& p) {
  ProjectedVertex out;
  out.x_fx = snap((clip.x / clip.w) * p.scale_x + p.middle_x);
  out.y_fx = snap((clip.y / clip.w) * p.scale_y + p.middle_y);
  const double depth = (clip.z / clip.w) * p.scale_depth + p.middle_depth;
  out.z_fx = round_to_nearest(std::clamp(depth * p.one, p.lowest, p.highest));
  out.inverse_w = 1.0 / clip.w;
  return out;
}

void project_vertices(const Projection& projection, const glm::vec4* clip, std::size_t count,
                      const ProjectedPlanes& out) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    if (!finite(clip[i]) || !projection.volume.contains(clip[i])) {
      out.x_fx[i] = kClipped;
      continue;
    }
    const ProjectedVertex vertex = project(clip[i], projection);
    out.x_fx[i] = vertex.x_fx;
    out.y_fx[i] = vertex.y_fx;
    out.z_fx[i] = vertex.z_fx;
    out.inverse_w[i] = vertex.inverse_w;
  }
}

}  // namespace gnomon::raster
