#include "pipeline/light_view.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace gnomon::pipeline {

void Rectangle::add(const glm::dvec2& p) {
  low = glm::min(low, p);
  high = glm::max(high, p);
}

LightView LightView::towards(const Light& light, const glm::dvec3& aim) {
  const glm::dvec3 at(light.position);
  if (light.position.w == 0.0f) return {false, aim, glm::normalize(-at)};
  return {true, at, glm::normalize(aim - at)};
}

LightView LightView::about(const Light& light, const glm::dvec3& axis) {
  return {true, glm::dvec3(light.position), axis};
}

HalfSpace LightView::beside(const glm::dvec3& along, double bound, double sign) const {
  const glm::dvec3 normal = is_point_ ? along - bound * basis_.axis : along;
  const double offset = is_point_ ? 0.0 : bound;
  return {sign * normal, sign * (offset + glm::dot(normal, origin_))};
}

std::array<HalfSpace, 4> LightView::sides(const Rectangle& r) const {
  return {beside(basis_.u, r.low.x, 1.0), beside(basis_.u, r.high.x, -1.0),
          beside(basis_.v, r.low.y, 1.0), beside(basis_.v, r.high.y, -1.0)};
}

std::array<glm::dvec3, 4> LightView::corners(const Rectangle& r) const {
  const auto at = [&](double x, double y) { return basis_.axis + x * basis_.u + y * basis_.v; };
  return {at(r.low.x, r.low.y), at(r.high.x, r.low.y), at(r.high.x, r.high.y),
          at(r.low.x, r.high.y)};
}

glm::mat4 LightView::clip_from_world(const Rectangle& r, double near, double far) const {
  const glm::dvec2 scale = 2.0 / r.extent(), shift = -(r.low + r.high) / r.extent();
  const double depth = 1.0 / (far - near);
  // Rows over (u, v, axis, 1).
  glm::dmat4 rows(0.0);
  rows[0] =
      is_point_ ? glm::dvec4(scale.x, 0.0, shift.x, 0.0) : glm::dvec4(scale.x, 0.0, 0.0, shift.x);
  rows[1] =
      is_point_ ? glm::dvec4(0.0, scale.y, shift.y, 0.0) : glm::dvec4(0.0, scale.y, 0.0, shift.y);
  rows[2] = is_point_ ? glm::dvec4(0.0, 0.0, (far + near) * depth, -2.0 * far * near * depth)
                      : glm::dvec4(0.0, 0.0, 2.0 * depth, -(far + near) * depth);
  rows[3] = is_point_ ? glm::dvec4(0.0, 0.0, 1.0, 0.0) : glm::dvec4(0.0, 0.0, 0.0, 1.0);
  glm::dmat4 local_rows(0.0);
  const std::array<glm::dvec3, 3> axes{basis_.u, basis_.v, basis_.axis};
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3& axis = axes[static_cast<std::size_t>(i)];
    local_rows[i] = glm::dvec4(axis, -glm::dot(axis, origin_));
  }
  local_rows[3] = glm::dvec4(0.0, 0.0, 0.0, 1.0);
  return glm::mat4(glm::transpose(rows) * glm::transpose(local_rows));
}

double LightView::depth_rate(double near, double far) const {
  return is_point_ ? far / ((far - near) * near) : 1.0 / (far - near);
}

}  // namespace gnomon::pipeline
