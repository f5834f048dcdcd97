#include "ar/mirror_ball.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ar/pose.h"

namespace gnomon::ar {

std::optional<Ray> pixel_ray(const Lens& lens, const glm::dmat4& world_from_camera,
                             glm::dvec2 pixel) {
  const std::optional<glm::dvec2> seen = lens.undistort(pixel);
  if (!seen) return std::nullopt;
  return Ray{glm::dvec3(world_from_camera[3]),
             glm::normalize(glm::dmat3(world_from_camera) * glm::dvec3(*seen, 1.0))};
}

std::optional<Reflection> reflect(const MirrorBall& ball, const Ray& ray) {
  const glm::dvec3 from_center = ray.origin - ball.center_m;
  const double along = -glm::dot(from_center, ray.direction);
  const glm::dvec3 nearest = from_center + ray.direction * along;
  const double half_squared = ball.radius_m * ball.radius_m - glm::dot(nearest, nearest);
  if (!(half_squared >= 0.0)) return std::nullopt;
  const double distance = along - std::sqrt(half_squared);
  if (!(distance > 0.0)) return std::nullopt;
  const glm::dvec3 normal = (from_center + ray.direction * distance) / ball.radius_m;
  const double cosine = -glm::dot(normal, ray.direction);
  return Reflection{{ball.center_m + normal * ball.radius_m,
                     glm::normalize(ray.direction + normal * (2.0 * cosine))},
                    cosine};
}

std::optional<glm::dvec3> mirror_point(const MirrorBall& ball, const glm::dvec3& eye,
                                       const glm::dvec4& towards) {
  constexpr int kMostSteps = 100;
  constexpr double kStill = 1e-8;
  glm::dvec3 point = ball.center_m;
  for (int step = 0; step < kMostSteps; ++step) {
    // The normal halves the angle between the two directions; each step turns it by a part of the
    // last turn that is about the ball's radius over the distance. Behind the ball it comes to no
    // rest.
    const glm::dvec3 to_eye = glm::normalize(eye - point);
    const glm::dvec3 to_light = glm::normalize(glm::dvec3(towards) - point * towards.w);
    const glm::dvec3 half = to_eye + to_light;
    const double length = glm::length(half);
    if (!(length > 1e-12)) return std::nullopt;
    const glm::dvec3 next = ball.center_m + half * (ball.radius_m / length);
    const bool still = glm::length(next - point) < kStill * ball.radius_m;
    point = next;
    if (still) return point;
  }
  return std::nullopt;
}

std::optional<BallOutline> ball_outline(const MirrorBall& ball, const Lens& lens,
                                        const glm::dmat4& world_from_camera, int width,
                                        int height) {
  constexpr int kPoints = 256;
  const glm::dvec3 center(rigid_inverse(world_from_camera) * glm::dvec4(ball.center_m, 1.0));
  const double distance = glm::length(center);
  if (!(distance > ball.radius_m)) return std::nullopt;
  // The circle where the cone of sight touches the ball.
  const glm::dvec3 axis = center / distance;
  const double sine = ball.radius_m / distance, cosine = std::sqrt(1.0 - sine * sine);
  const glm::dvec3 rim_center = center - axis * (ball.radius_m * sine);
  const glm::dvec3 aside = std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, aside)), v = glm::cross(axis, u);
  glm::dvec2 low(1e300), high(-1e300);
  int imaged = 0, inside = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPoints;
    const glm::dvec3 point =
        rim_center + (u * std::cos(angle) + v * std::sin(angle)) * (ball.radius_m * cosine);
    const std::optional<glm::dvec2> pixel = lens.project(point);
    if (!pixel) continue;
    ++imaged;
    low = glm::min(low, *pixel);
    high = glm::max(high, *pixel);
    inside +=
        pixel->x >= -0.5 && pixel->y >= -0.5 && pixel->x <= width - 0.5 && pixel->y <= height - 0.5
            ? 1
            : 0;
  }
  if (imaged == 0) return std::nullopt;
  BallOutline outline;
  const auto bound = [](double value, int most) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
  };
  outline.x0 = bound(std::floor(low.x), width);
  outline.y0 = bound(std::floor(low.y), height);
  outline.x1 = bound(std::ceil(high.x) + 1.0, width);
  outline.y1 = bound(std::ceil(high.y) + 1.0, height);
  outline.radius_px = 0.25 * ((high.x - low.x) + (high.y - low.y));
  outline.inside = static_cast<double>(inside) / kPoints;
  return outline;
}

}  // namespace gnomon::ar
