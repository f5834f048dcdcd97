#include "ar/toml_pose.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "ar/pose.h"

namespace gnomon::ar {

namespace {

/// R = Rz * Ry * Rx: first about x, then about y, then about z, axes fixed.
glm::dmat3 rotation_from_degrees(glm::dvec3 degrees) {
  const glm::dvec3 a = glm::radians(degrees);
  return glm::mat3_cast(glm::angleAxis(a.z, glm::dvec3(0, 0, 1)) *
                        glm::angleAxis(a.y, glm::dvec3(0, 1, 0)) *
                        glm::angleAxis(a.x, glm::dvec3(1, 0, 0)));
}

glm::dmat3 read_rotation(const TomlTable& t) {
  if (t.has("rotation_deg") && t.has("quaternion"))
    t.fail("quaternion", "together with rotation_deg: give one of them");
  if (const auto degrees = t.vector("rotation_deg", -3600.0, 3600.0))
    return rotation_from_degrees(*degrees);
  if (const auto q = t.numbers("quaternion", 4)) {
    const glm::dquat value((*q)[3], (*q)[0], (*q)[1], (*q)[2]);
    if (std::abs(glm::length(value) - 1.0) > kRigidTolerance)
      t.fail("quaternion", fmt::format("has length {}, not 1", glm::length(value)));
    return glm::mat3_cast(glm::normalize(value));
  }
  return glm::dmat3(1.0);
}

}  // namespace

glm::dmat4 read_pose(const TomlTable& t, std::string_view matrix_key, bool scalable) {
  if (const auto matrix = t.matrix(matrix_key)) {
    for (const char* key : {"position_m", "rotation_deg", "quaternion", "scale"})
      if (t.has(key)) t.fail(key, fmt::format("together with {}: give one of them", matrix_key));
    const glm::dmat3 linear(*matrix);
    if (!scalable && !is_rotation(linear))
      t.fail(matrix_key, fmt::format("is not a rotation and translation (determinant {})",
                                     glm::determinant(linear)));
    if (glm::determinant(linear) < 1e-12)
      t.fail(matrix_key,
             fmt::format("mirrors or flattens (determinant {})", glm::determinant(linear)));
    return *matrix;
  }
  glm::dmat4 pose(read_rotation(t));
  if (scalable)
    if (const auto scale = t.number("scale", 1e-4, 1e4))
      pose = glm::dmat4(glm::dmat3(pose) * *scale);
  const glm::dvec3 position =
      t.vector("position_m", -kMaxMetres, kMaxMetres).value_or(glm::dvec3(0.0));
  pose[3] = glm::dvec4(position, 1.0);
  return pose;
}

glm::dmat4 read_world_from_camera(const TomlTable& t) {
  const std::string axes = t.text("axes").value_or("opencv");
  if (axes != "opencv" && axes != "opengl")
    t.fail("axes", fmt::format("'{}' is not one of opencv, opengl", axes));
  const glm::dmat4 pose = read_pose(t, "world_from_camera", false);
  return axes == "opengl" ? pose * opengl_from_opencv_axes() : pose;
}

glm::dmat4 read_look_at(const TomlTable& t) {
  const glm::dvec3 eye = t.required("eye_m", t.vector("eye_m", -kMaxMetres, kMaxMetres));
  const glm::dvec3 target = t.required("target_m", t.vector("target_m", -kMaxMetres, kMaxMetres));
  const glm::dvec3 up = t.vector("up").value_or(glm::dvec3(0.0, 1.0, 0.0));
  const glm::dvec3 forward = target - eye;
  if (!(glm::length(forward) > 1e-9)) t.fail("target_m", "is where the eye is");
  const glm::dvec3 right = glm::cross(forward, up);
  if (!(glm::length(right) > 1e-9 * glm::length(forward)))
    t.fail(t.has("up") ? "up" : "target_m", "the eye looks along the direction that is up");
  const glm::dvec3 z = glm::normalize(forward), x = glm::normalize(right);
  return {glm::dvec4(x, 0.0), glm::dvec4(glm::cross(z, x), 0.0), glm::dvec4(z, 0.0),
          glm::dvec4(eye, 1.0)};
}

}  // namespace gnomon::ar
