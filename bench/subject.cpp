#include "bench/subject.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "bench/models.h"
#include "bench/tori.h"

namespace gnomon::bench {
namespace {

constexpr int kMaxEdge = 16384, kMaxTori = 4096, kMinGrid = 600, kMaxGrid = 20'000'000;

/// A whole number from `low` to `high` that is all of the text.
std::optional<int> number(std::string_view text, int low, int high) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || value < low || value > high) return std::nullopt;
  return value;
}

std::optional<int> number_after(std::string_view text, std::string_view start, int low, int high) {
  if (!text.starts_with(start)) return std::nullopt;
  return number(text.substr(start.size()), low, high);
}

/// Twelve tori of 2 * ring * tube triangles each, with twice as many quads around the ring as
/// around the tube.
Tessellation tessellation_for(int triangles) {
  const int tube = std::max(3, static_cast<int>(std::lround(std::sqrt(triangles / 48.0))));
  return {.ring = 2 * tube, .tube = tube};
}

}  // namespace

std::string text(Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

Size size_from(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross != std::string_view::npos) {
    const auto width = number(text.substr(0, cross), 1, kMaxEdge);
    const auto height = number(text.substr(cross + 1), 1, kMaxEdge);
    if (width && height) return {*width, *height};
  }
  throw std::invalid_argument("'" + std::string(text) +
                              "' is no size: it is WIDTHxHEIGHT, each from 1 to 16384 pixels");
}

Subject make_subject(const std::string& name, Size size,
                     std::span<const std::filesystem::path> models) {
  Subject subject{.name = name, .size = size};
  subject.camera = tori_camera(size.width, size.height);
  if (const auto tori = number_after(name, "tori-", 1, kMaxTori)) {
    subject.scene = tori_scene(*tori);
  } else if (const auto triangles = number_after(name, "grid-", kMinGrid, kMaxGrid)) {
    subject.scene = tori_scene(12, tessellation_for(*triangles));
  } else if (const auto depth_tori = number_after(name, "depth-", 1, kMaxTori)) {
    subject.kind = Kind::depth;
    subject.scene = tori_scene(*depth_tori);
  } else if (name == "map") {
    subject.kind = Kind::depth;
    subject.scene = tori_scene(12);
    subject.camera = light_camera(size.width, size.height);
  } else if (name == "layer-decided" || name == "layer-random") {
    subject.kind = Kind::layer;
    subject.random_depth = name == "layer-random";
  } else if (name == "meshes") {
    subject.scene = meshes_scene(models);
  } else if (name == "desk") {
    World world = desk_world(size.width, size.height);
    subject.scene = std::move(world.scene);
    subject.camera = world.camera;
  } else {
    throw std::invalid_argument("there is no scene '" + name + "' (--list names them)");
  }
  return subject;
}

const std::vector<UsualSubject>& usual_subjects() {
  static const std::vector<Size> kScreens{{640, 480}, {1280, 720}, {1920, 1080}};
  static const std::vector<UsualSubject> kSubjects{
      {"tori-12", "12 tori above a plane, 27,650 triangles", kScreens},
      {"tori-64", "64 tori above a plane, 147,458 triangles", kScreens},
      {"desk", "the captured desk with a virtual torus and sphere", kScreens},
      {"meshes", "nine small models at once, open and closed", kScreens},
      {"layer-decided", "a layer that fails the depth test in whole blocks", kScreens},
      {"layer-random", "a layer over random depths", kScreens},
      {"map", "tori-12 from its light, depth only", {{256, 256}}},
      {"depth-12", "tori-12, depth only", {{256, 256}, {640, 480}}},
      {"depth-64", "tori-64, depth only", {{1920, 1080}}},
  };
  return kSubjects;
}

}  // namespace gnomon::bench
