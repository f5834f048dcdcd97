#include "ar/refine.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

namespace gnomon::ar {
namespace {

constexpr double kStep_px = 0.25;
constexpr int kMinSamples = 4;
/// Half a profile's length: as far as the neighbouring modules leave flat ground. Best of 0.6,
/// 0.75, 0.9 and 1.1 modules on rendered photographs with known corners (docs/tracking.md).
constexpr double kReachModules = 0.6, kMinReach_px = 1.25, kMaxReach_px = 4.0;

/// Bilinear value, or nothing outside the picture.
std::optional<double> value_at(const LightPlane& light, glm::dvec2 p) {
  if (!(p.x >= 0.0 && p.y >= 0.0 && p.x <= light.width - 1.0 && p.y <= light.height - 1.0)) {
    return std::nullopt;
  }
  const int x = std::min(static_cast<int>(p.x), light.width - 2);
  const int y = std::min(static_cast<int>(p.y), light.height - 2);
  const double u = p.x - x, v = p.y - y;
  const float* at = light.values.data() + static_cast<std::size_t>(y) * light.width + x;
  return (1 - v) * ((1 - u) * at[0] + u * at[1]) +
         v * ((1 - u) * at[light.width] + u * at[light.width + 1]);
}

struct EdgePoint {
  glm::dvec2 at;
  double weight;
};

/// Where the profile through `centre` along `to_bright` crosses the middle between the levels at
/// its two ends; `reach` is half its length.
std::optional<EdgePoint> edge_point(const LightPlane& light, glm::dvec2 centre,
                                    glm::dvec2 to_bright, double reach) {
  constexpr int kMaxHalf = 24;
  const int half = std::min(static_cast<int>(std::lround(reach / kStep_px)), kMaxHalf);
  double profile[2 * kMaxHalf + 1];
  for (int i = -half; i <= half; ++i) {
    const auto v = value_at(light, centre + to_bright * (i * kStep_px));
    if (!v) return std::nullopt;
    profile[i + half] = *v;
  }
  const int last = 2 * half, plateau = std::max(1, half / 4);
  double dark = 0.0, bright = 0.0;
  for (int i = 0; i < plateau; ++i) {
    dark += profile[i] / plateau;
    bright += profile[last - i] / plateau;
  }
  constexpr double kMinContrast = 0.01;
  if (bright - dark < kMinContrast) return std::nullopt;
  const double middle = 0.5 * (dark + bright);
  // The crossing nearest to the centre.
  std::optional<double> best;
  for (int i = 0; i < last; ++i) {
    if (profile[i] < middle && profile[i + 1] >= middle) {
      const double x = i - half + (middle - profile[i]) / (profile[i + 1] - profile[i]);
      if (!best || std::abs(x) < std::abs(*best)) best = x;
    }
  }
  if (!best) return std::nullopt;
  return EdgePoint{centre + to_bright * (*best * kStep_px), bright - dark};
}

struct Line {
  glm::dvec2 point, normal;
};

/// Total least squares with Huber weights, so that an occluded stretch does not turn the line.
std::optional<Line> fit_line(const std::vector<EdgePoint>& points, double huber) {
  if (points.size() < kMinSamples) return std::nullopt;
  std::vector<double> weights;
  for (const EdgePoint& p : points) weights.push_back(p.weight);
  Line line{};
  for (int iteration = 0; iteration < 6; ++iteration) {
    double sum = 0.0;
    glm::dvec2 mean{0.0};
    for (std::size_t i = 0; i < points.size(); ++i) {
      mean += weights[i] * points[i].at;
      sum += weights[i];
    }
    mean /= sum;
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec2 d = points[i].at - mean;
      xx += weights[i] * d.x * d.x;
      xy += weights[i] * d.x * d.y;
      yy += weights[i] * d.y * d.y;
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    line = {mean, {-std::sin(angle), std::cos(angle)}};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double off = std::abs(glm::dot(points[i].at - mean, line.normal));
      weights[i] = points[i].weight * (off <= huber ? 1.0 : huber / off);
    }
  }
  return line;
}

std::optional<glm::dvec2> meet(const Line& a, const Line& b) {
  const double determinant = a.normal.x * b.normal.y - a.normal.y * b.normal.x;
  constexpr double kMinSine = 0.05;
  if (std::abs(determinant) < kMinSine) return std::nullopt;
  const double da = glm::dot(a.normal, a.point), db = glm::dot(b.normal, b.point);
  return glm::dvec2(da * b.normal.y - db * a.normal.y, db * a.normal.x - da * b.normal.x) /
         determinant;
}

/// Pixels to coordinates in which straight edges are straight, in units of about a pixel.
std::optional<glm::dvec2> straight_from_pixel(const Lens* lens, glm::dvec2 p) {
  if (lens == nullptr) return p;
  const auto n = lens->undistort(p);
  if (!n) return std::nullopt;
  return glm::dvec2(n->x * lens->camera().fx, n->y * lens->camera().fy);
}

std::optional<glm::dvec2> pixel_from_straight(const Lens* lens, glm::dvec2 s) {
  if (lens == nullptr) return s;
  return lens->project({s.x / lens->camera().fx, s.y / lens->camera().fy, 1.0});
}

/// The edge from corner i to the next.
std::optional<Line> edge_line(const LightPlane& light, const TagCorners& corners, std::size_t i,
                              const SquareLook& look, const Lens* lens) {
  const glm::dvec2 from = corners[i], to = corners[(i + 1) % 4];
  const double length = glm::length(to - from);
  const glm::dvec2 along = (to - from) / length;
  // Corners go clockwise as seen in the picture (y down): outside is to the left.
  const glm::dvec2 outward{along.y, -along.x};
  const glm::dvec2 to_bright = look.white_inside ? -outward : outward;
  // Foreshortening makes modules across an edge smaller than along it.
  const glm::dvec2 opposite = 0.5 * (corners[(i + 2) % 4] + corners[(i + 3) % 4]);
  const double across_px = std::abs(glm::dot(opposite - 0.5 * (from + to), outward)) / look.modules;
  const double reach = std::clamp(kReachModules * across_px, kMinReach_px, kMaxReach_px);
  const double margin = std::min(std::max(1.5, 0.5 * length / look.modules), 0.3 * length);
  const int count = std::clamp(static_cast<int>(std::lround(length - 2.0 * margin)), 8, 400);
  std::vector<EdgePoint> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int sample = 0; sample < count; ++sample) {
    const double t = margin + (length - 2.0 * margin) * (sample + 0.5) / count;
    auto point = edge_point(light, from + along * t, to_bright, reach);
    if (!point) continue;
    const auto straight = straight_from_pixel(lens, point->at);
    if (straight) points.push_back({*straight, point->weight});
  }
  if (static_cast<int>(points.size()) < count / 3) return std::nullopt;
  constexpr double kHuber_px = 0.3;
  return fit_line(points, kHuber_px);
}

std::optional<TagCorners> refine_once(const LightPlane& light, const TagCorners& rough,
                                      const SquareLook& look, const Lens* lens) {
  std::array<Line, 4> lines;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto line = edge_line(light, rough, i, look, lens);
    if (!line) return std::nullopt;
    lines[i] = *line;
  }
  TagCorners result;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto corner = meet(lines[(i + 3) % 4], lines[i]);
    if (!corner) return std::nullopt;
    const auto pixel = pixel_from_straight(lens, *corner);
    if (!pixel) return std::nullopt;
    result[i] = *pixel;
  }
  return result;
}

}  // namespace

TagCorners refine_corners(const LightPlane& light, const TagCorners& rough, const SquareLook& look,
                          const Lens* lens) {
  if (light.width < 2 || light.height < 2) return rough;
  double shortest = glm::length(rough[0] - rough[3]);
  for (std::size_t i = 0; i < 3; ++i) {
    shortest = std::min(shortest, glm::length(rough[i + 1] - rough[i]));
  }
  constexpr double kSmallestEdge_px = 8.0;
  if (!(shortest >= kSmallestEdge_px)) return rough;
  const double leash = std::max(1.5, shortest / look.modules);
  TagCorners corners = rough;
  // A second pass, because the first one's profiles start where the rough edge was.
  for (int pass = 0; pass < 2; ++pass) {
    const auto better = refine_once(light, corners, look, lens);
    if (!better) return rough;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!(glm::length((*better)[i] - rough[i]) <= leash)) return rough;
    }
    corners = *better;
  }
  return corners;
}

}  // namespace gnomon::ar
