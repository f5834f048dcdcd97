#include "ar/camera.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "ar/error.h"
#include "raster/check.h"

namespace gnomon::ar {
namespace {

constexpr double kRadiusLimit = 100.0;
/// Below this the rational model's denominator is taken for its pole.
constexpr double kSmallestDenominator = 1e-3;

bool known_count(LensKind lens, std::size_t n) {
  if (lens == LensKind::fisheye) return n == 0 || n == 4;
  return n == 0 || n == 4 || n == 5 || n == 8 || n == 12 || n == 14;
}

/// OpenCV's matTilt: the projection of a sensor turned by tau_x, then tau_y.
glm::dmat3 tilt_matrix(double tau_x, double tau_y) {
  const double cx = std::cos(tau_x), sx = std::sin(tau_x);
  const double cy = std::cos(tau_y), sy = std::sin(tau_y);
  const glm::dmat3 about_x(1, 0, 0, 0, cx, -sx, 0, sx, cx);
  const glm::dmat3 about_y(cy, 0, sy, 0, 1, 0, -sy, 0, cy);
  const glm::dmat3 r = about_y * about_x;
  const glm::dmat3 onto_plane(r[2][2], 0, 0, 0, r[2][2], 0, -r[2][0], -r[2][1], 1);
  return onto_plane * r;
}

glm::dvec2 through(const glm::dmat3& m, glm::dvec2 p) {
  const glm::dvec3 q = m * glm::dvec3(p, 1.0);
  return {q.x / q.z, q.y / q.z};
}

}  // namespace

CameraModel pinhole_camera(int width, int height, double focal_px) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_px;
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  return camera;
}

double focal_for(int height, double fov_y_rad) {
  return height / (2.0 * std::tan(fov_y_rad / 2.0));
}

CameraModel camera_for_picture(const CameraModel& camera, int width, int height) {
  raster::require(width > 0 && height > 0, "a picture has pixels");
  CameraModel result = camera;
  result.width = width;
  result.height = height;
  if (camera.width == 0 || (camera.width == width && camera.height == height)) return result;
  const double sx = static_cast<double>(width) / camera.width;
  const double sy = static_cast<double>(height) / camera.height;
  if (std::abs(camera.height * sx - height) > 1.0 && std::abs(camera.width * sy - width) > 1.0) {
    throw InputError(fmt::format("camera: made for {} x {} pixels, but the picture has {} x {}",
                                 camera.width, camera.height, width, height));
  }
  result.fx = camera.fx * sx;
  result.fy = camera.fy * sy;
  result.cx = (camera.cx + 0.5) * sx - 0.5;
  result.cy = (camera.cy + 0.5) * sy - 0.5;
  return result;
}

Lens::Lens(const CameraModel& camera) : camera_(camera) {
  raster::require(known_count(camera.lens, camera.distortion.size()),
                  "a lens has 0, 4, 5, 8, 12 or 14 coefficients (fisheye: 0 or 4)");
  raster::require(std::isfinite(camera.fx) && std::isfinite(camera.fy) && camera.fx > 0.0 &&
                      camera.fy > 0.0 && std::isfinite(camera.cx) && std::isfinite(camera.cy),
                  "a camera's focal lengths are positive and its centre is finite");
  for (std::size_t i = 0; i < camera.distortion.size(); ++i) {
    raster::require(std::isfinite(camera.distortion[i]), "a lens coefficient is finite");
    k_[i] = camera.distortion[i];
  }
  tilted_ = camera.lens == LensKind::brown_conrady && (k_[12] != 0.0 || k_[13] != 0.0);
  if (tilted_) {
    tilt_ = tilt_matrix(k_[12], k_[13]);
    untilt_ = glm::inverse(tilt_);
  }
  // The first maximum of the distorted radius: walk up in steps of 1 %, then narrow down.
  constexpr double kStep = 1.01;
  double below = 0.0, at = 1e-3;
  while (at < kRadiusLimit && distorted_radius(at * kStep) > distorted_radius(at)) {
    below = at;
    at *= kStep;
  }
  double low = below, high = std::min(at * kStep, kRadiusLimit);
  if (at < kRadiusLimit) {
    for (int i = 0; i < 100; ++i) {
      const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
      (distorted_radius(a) < distorted_radius(b) ? low : high) =
          distorted_radius(a) < distorted_radius(b) ? a : b;
    }
    high = low;
  }
  max_radius_ = high;
  max_distorted_ = distorted_radius(high);
}

double Lens::radial_scale(double r2) const {
  if (camera_.lens == LensKind::fisheye) {
    const double r = std::sqrt(r2);
    if (r < 1e-12) return 1.0;
    const double a = std::atan(r), a2 = a * a;
    return a * (1.0 + a2 * (k_[0] + a2 * (k_[1] + a2 * (k_[2] + a2 * k_[3])))) / r;
  }
  return (1.0 + r2 * (k_[0] + r2 * (k_[1] + r2 * k_[4]))) /
         (1.0 + r2 * (k_[5] + r2 * (k_[6] + r2 * k_[7])));
}

double Lens::distorted_radius(double radius) const {
  const double r2 = radius * radius;
  if (camera_.lens == LensKind::brown_conrady &&
      1.0 + r2 * (k_[5] + r2 * (k_[6] + r2 * k_[7])) < kSmallestDenominator) {
    return -1.0;
  }
  return radius * radial_scale(r2);
}

double Lens::undistorted_radius(double distorted) const {
  double low = 0.0, high = max_radius_;
  for (int i = 0; i < 60 && high - low > 1e-9; ++i) {
    const double middle = 0.5 * (low + high);
    (distorted_radius(middle) < distorted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

glm::dvec2 Lens::brown_untilted(glm::dvec2 n) const {
  const double r2 = glm::dot(n, n), r4 = r2 * r2, xy = n.x * n.y;
  const double scale = radial_scale(r2);
  return {
      n.x * scale + 2.0 * k_[2] * xy + k_[3] * (r2 + 2.0 * n.x * n.x) + k_[8] * r2 + k_[9] * r4,
      n.y * scale + k_[2] * (r2 + 2.0 * n.y * n.y) + 2.0 * k_[3] * xy + k_[10] * r2 + k_[11] * r4};
}

glm::dvec2 Lens::distort(glm::dvec2 normalised) const {
  if (camera_.distortion.empty() && camera_.lens == LensKind::brown_conrady) return normalised;
  if (camera_.lens == LensKind::fisheye) {
    return normalised * radial_scale(glm::dot(normalised, normalised));
  }
  const glm::dvec2 flat = brown_untilted(normalised);
  return tilted_ ? through(tilt_, flat) : flat;
}

glm::dvec2 Lens::pixel_from_distorted(glm::dvec2 d) const {
  return {d.x * camera_.fx + camera_.cx, d.y * camera_.fy + camera_.cy};
}

std::optional<glm::dvec2> Lens::undistort(glm::dvec2 pixel) const {
  const glm::dvec2 seen{(pixel.x - camera_.cx) / camera_.fx, (pixel.y - camera_.cy) / camera_.fy};
  if (!std::isfinite(seen.x) || !std::isfinite(seen.y)) return std::nullopt;
  const glm::dvec2 target = tilted_ ? through(untilt_, seen) : seen;
  const double radius = glm::length(target);
  // Tangential and prism terms shift a point a little across the radial limit.
  constexpr double kSlack = 1.05;
  if (!(radius <= max_distorted_ * kSlack)) return std::nullopt;
  if (radius < 1e-15) return target;
  const double start = undistorted_radius(std::min(radius, max_distorted_));
  glm::dvec2 n = target * (start / radius);
  if (camera_.lens == LensKind::fisheye) {
    return radius <= max_distorted_ ? std::optional(n) : std::nullopt;
  }
  for (int i = 0; i < 20; ++i) {
    const glm::dvec2 miss = target - brown_untilted(n);
    if (std::abs(miss.x) + std::abs(miss.y) < 1e-13) break;
    constexpr double kH = 1e-6;
    const glm::dvec2 dx =
        (brown_untilted(n + glm::dvec2(kH, 0)) - brown_untilted(n - glm::dvec2(kH, 0))) /
        (2.0 * kH);
    const glm::dvec2 dy =
        (brown_untilted(n + glm::dvec2(0, kH)) - brown_untilted(n - glm::dvec2(0, kH))) /
        (2.0 * kH);
    const double determinant = dx.x * dy.y - dx.y * dy.x;
    if (!(determinant > 1e-12)) return std::nullopt;
    n += glm::dvec2(miss.x * dy.y - miss.y * dy.x, miss.y * dx.x - miss.x * dx.y) / determinant;
  }
  const glm::dvec2 miss = target - brown_untilted(n);
  const bool converged = std::abs(miss.x) + std::abs(miss.y) < 1e-9;
  if (!converged || !(glm::length(n) <= max_radius_)) return std::nullopt;
  return n;
}

std::optional<glm::dvec2> Lens::project(glm::dvec3 p) const {
  if (!(p.z > 0.0)) return std::nullopt;
  const glm::dvec2 n{p.x / p.z, p.y / p.z};
  if (!(glm::dot(n, n) <= max_radius_ * max_radius_)) return std::nullopt;
  return pixel_from_distorted(distort(n));
}

}  // namespace gnomon::ar
