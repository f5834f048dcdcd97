#include "apps/study/tag_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <glm/geometric.hpp>

#include "apps/study/picture_damage.h"

namespace gnomon::apps::study {

namespace {

constexpr int kModules = 10;
/// With its white border, from the top row; the black square is eight modules wide.
constexpr std::string_view kTag[kModules] = {"##########", "#........#", "#.##.#.#.#", "#..###.#.#",
                                             "#..##....#", "#.#.#....#", "#..#.##..#", "#....#...#",
                                             "#........#", "##########"};
/// Light of a grey table, of paper and of ink.
constexpr double kTable = 0.2, kWhite = 0.6, kBlack = 0.02;

double light_at(const glm::dvec2& tag_m, double module_m) {
  const double u = std::floor(tag_m.x / module_m + 0.5 * kModules);
  const double v = std::floor(0.5 * kModules - tag_m.y / module_m);
  if (u < 0.0 || v < 0.0 || u >= kModules || v >= kModules) return kTable;
  return kTag[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)] == '#' ? kWhite : kBlack;
}

}  // namespace

ar::Image picture_of_tag(const ar::Lens& lens, const glm::dmat4& camera_from_tag, double size_m,
                         const ar::Response& response) {
  constexpr int kSamples = 4;
  const int width = lens.camera().width, height = lens.camera().height;
  const double module_m = size_m / 8.0;
  glm::dvec2 low(width, height), high(0.0);
  for (const ar::TagCorners::value_type& sign :
       {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)}) {
    const glm::dvec4 corner(sign * (0.5 * kModules * module_m), 0.0, 1.0);
    const std::optional<glm::dvec2> pixel = lens.project(glm::dvec3(camera_from_tag * corner));
    if (!pixel) continue;
    low = glm::min(low, *pixel);
    high = glm::max(high, *pixel);
  }
  const glm::dmat4 tag_from_camera = glm::inverse(camera_from_tag);
  const glm::dvec3 eye(tag_from_camera[3]);
  const auto light = [&](double x, double y) {
    const std::optional<glm::dvec2> ray = lens.undistort({x, y});
    if (!ray) return kTable;
    const glm::dvec3 along = glm::dmat3(tag_from_camera) * glm::dvec3(*ray, 1.0);
    // The tag's plane is z = 0, and the eye before it.
    if (along.z >= 0.0) return kTable;
    return light_at(glm::dvec2(eye - along * (eye.z / along.z)), module_m);
  };
  ar::Image out{width, height, 3, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sum = kTable;
      if (x >= low.x - 2.0 && x <= high.x + 2.0 && y >= low.y - 2.0 && y <= high.y + 2.0) {
        sum = 0.0;
        for (int j = 0; j < kSamples; ++j)
          for (int i = 0; i < kSamples; ++i)
            sum += light(x + (i + 0.5) / kSamples - 0.5, y + (j + 0.5) / kSamples - 0.5);
        sum /= kSamples * kSamples;
      }
      for (std::size_t c = 0; c < 3; ++c) out.pixels.push_back(value_of_light(response, c, sum));
    }
  }
  return out;
}

glm::dmat4 world_from_camera_at(const glm::dvec3& at, double distance_m, double from_vertical_rad,
                                double side_rad) {
  const double s = std::sin(from_vertical_rad), c = std::cos(from_vertical_rad);
  const glm::dvec3 side(std::cos(side_rad), 0.0, -std::sin(side_rad));
  const glm::dvec3 back = s * side + glm::dvec3(0.0, c, 0.0);
  const glm::dvec3 up = glm::dvec3(0.0, s, 0.0) - c * side;
  return glm::dmat4(glm::dvec4(glm::cross(-back, up), 0.0), glm::dvec4(-up, 0.0),
                    glm::dvec4(-back, 0.0), glm::dvec4(at + distance_m * back, 1.0));
}

}  // namespace gnomon::apps::study
