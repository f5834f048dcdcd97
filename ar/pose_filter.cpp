#include "ar/pose_filter.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "raster/check.h"

namespace gnomon::ar {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Weight of the new value in a first-order low-pass.
double weight(double cutoff_hz, double dt_s) {
  const double r = 2.0 * kPi * cutoff_hz * dt_s;
  return r / (r + 1.0);
}

/// Rotation vector of the way from a to b, the short one.
glm::dvec3 rotation_vector(const glm::dquat& a, const glm::dquat& b) {
  glm::dquat q = b * glm::conjugate(a);
  if (q.w < 0.0) q = -q;
  const glm::dvec3 v{q.x, q.y, q.z};
  const double sine = glm::length(v);
  if (sine < 1e-15) return glm::dvec3(0.0);
  return v * (2.0 * std::atan2(sine, q.w) / sine);
}

}  // namespace

PoseFilter::PoseFilter(const OneEuroOptions& options) : options_(options) {
  raster::require(options.min_cutoff_hz > 0.0 && options.speed_cutoff_hz > 0.0 &&
                      options.beta_per_m >= 0.0 && options.beta_per_rad >= 0.0,
                  "a filter's cut-offs are positive and its betas are not negative");
}

glm::dmat4 PoseFilter::filter(const glm::dmat4& pose, double time_s) {
  const glm::dvec3 position(pose[3]);
  const glm::dquat rotation = glm::normalize(glm::quat_cast(glm::dmat3(pose)));
  const double dt_s = last_ ? time_s - last_->time_s : 0.0;
  if (!(dt_s > 0.0)) {
    last_ = Memory{.time_s = time_s,
                   .position = position,
                   .rotation = rotation,
                   .raw_position = position,
                   .raw_rotation = rotation};
    return pose;
  }
  Memory& m = *last_;
  const double speed_weight = weight(options_.speed_cutoff_hz, dt_s);
  m.velocity += speed_weight * ((position - m.raw_position) / dt_s - m.velocity);
  m.turning += speed_weight * (rotation_vector(m.raw_rotation, rotation) / dt_s - m.turning);
  const double position_cutoff =
      options_.min_cutoff_hz + options_.beta_per_m * glm::length(m.velocity);
  const double rotation_cutoff =
      options_.min_cutoff_hz + options_.beta_per_rad * glm::length(m.turning);
  m.position += weight(position_cutoff, dt_s) * (position - m.position);
  m.rotation = glm::normalize(glm::slerp(m.rotation, rotation, weight(rotation_cutoff, dt_s)));
  m.raw_position = position;
  m.raw_rotation = rotation;
  m.time_s = time_s;
  glm::dmat4 result = glm::mat4_cast(m.rotation);
  result[3] = glm::dvec4(m.position, 1.0);
  return result;
}

}  // namespace gnomon::ar
