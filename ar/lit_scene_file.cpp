#include "ar/lit_scene_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "ar/base64.h"
#include "ar/error.h"
#include "ar/file.h"
#include "raster/check.h"

namespace gnomon::ar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::string_view kFormat = "gnomon lit scene";
constexpr int kVersion = 2;
constexpr int kMaxMapSide = 4096;
constexpr std::size_t kMaxPatches = 100'000;
constexpr float kLargest = 1e30f;

std::string base64_of(const std::vector<glm::vec3>& vectors) {
  std::vector<float> values;
  for (const glm::vec3& v : vectors) values.insert(values.end(), {v.x, v.y, v.z});
  return base64_from_floats(values);
}

ordered_json model_json(const pipeline::PatchModel& model) {
  std::vector<glm::vec3> positions, normals;
  for (const pipeline::PatchVertex& v : model.vertices) {
    positions.push_back(v.position);
    normals.push_back(v.normal);
  }
  std::vector<std::uint32_t> corners, surfaces;
  for (const pipeline::Patch& p : model.patches) {
    corners.insert(corners.end(), p.vertices.begin(), p.vertices.end());
    surfaces.push_back(p.surface);
  }
  return {{"surfaces", model.surfaces},
          {"longest_edge_m", model.longest_edge_m},
          {"vertices", model.vertices.size()},
          {"positions_m", base64_of(positions)},
          {"normals", base64_of(normals)},
          {"patches", model.patches.size()},
          {"patch_vertices", base64_from_integers(corners)},
          {"patch_surface", base64_from_integers(surfaces)},
          {"distant_patches", model.patches.size() - model.near_count()},
          {"clear_surfaces", model.clear_surfaces}};
}

/// Reads one file, and says where in it something is wrong.
class Reader {
 public:
  explicit Reader(const fs::path& file) : name_(one_line(file.string())) {
    const std::vector<std::uint8_t> bytes = read_file(file, kMaxLitSceneBytes);
    root_ = json::parse(bytes, nullptr, false);
    if (root_.is_discarded() || !root_.is_object()) fail("", "not a JSON object");
  }

  pipeline::LitScene read() {
    if (!root_.contains("format") || root_["format"] != kFormat)
      fail("format", fmt::format("is not \"{}\"", kFormat));
    if (!root_.contains("version") || root_["version"] != kVersion)
      fail("version", fmt::format("is not {}, which is read: capture the scene again", kVersion));
    pipeline::LitScene scene;
    read_model(scene.model);
    const std::size_t patches = scene.model.patches.size();
    scene.radiance = vectors(root_, "radiance", patches, 0.0f, kLargest);
    scene.reflectance = vectors(root_, "reflectance", patches, 0.0f, 1.0f);
    read_tone(scene.tone);
    read_probe(scene.probe);
    return scene;
  }

 private:
  [[noreturn]] void fail(std::string_view place, std::string_view what) const {
    throw InputError(
        one_line(fmt::format("{}: {}{}{}", name_, place, place.empty() ? "" : ": ", what)));
  }

  const json& member(const json& object, const char* key) const {
    if (!object.is_object() || !object.contains(key)) fail(key, "missing");
    return object[key];
  }
  std::size_t size(const json& object, const char* key, std::size_t low, std::size_t high) const {
    const json& value = member(object, key);
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() < low ||
        value.get<std::uint64_t>() > high)
      fail(key, fmt::format("is not a whole number within {} to {}", low, high));
    return value.get<std::size_t>();
  }
  const std::string& text(const json& object, const char* key) const {
    const json& value = member(object, key);
    if (!value.is_string()) fail(key, "is not a text");
    return value.get_ref<const std::string&>();
  }
  std::vector<float> floats(const json& object, const char* key, std::size_t count, float low,
                            float high) const {
    const auto values = floats_from_base64(text(object, key));
    if (!values || values->size() != count)
      fail(key, fmt::format("is not base64 of {} numbers", count));
    for (std::size_t i = 0; i < count; ++i)
      // NaN is within nothing.
      if (!((*values)[i] >= low && (*values)[i] <= high))
        fail(key,
             fmt::format("number {} is {:g}, not within {:g} to {:g}", i, (*values)[i], low, high));
    return *values;
  }
  std::vector<glm::vec3> vectors(const json& object, const char* key, std::size_t count, float low,
                                 float high) const {
    const std::vector<float> values = floats(object, key, 3 * count, low, high);
    std::vector<glm::vec3> result;
    result.reserve(count);
    for (std::size_t i = 0; i < values.size(); i += 3)
      result.emplace_back(values[i], values[i + 1], values[i + 2]);
    return result;
  }
  std::vector<std::uint32_t> indices(const json& object, const char* key, std::size_t count,
                                     std::size_t targets) const {
    const auto values = integers_from_base64(text(object, key));
    if (!values || values->size() != count)
      fail(key, fmt::format("is not base64 of {} numbers", count));
    for (std::size_t i = 0; i < count; ++i)
      if ((*values)[i] >= targets)
        fail(key, fmt::format("number {} is {}, not below {}", i, (*values)[i], targets));
    return *values;
  }

  void read_model(pipeline::PatchModel& model) const {
    const json& object = member(root_, "model");
    const json& names = member(object, "surfaces");
    if (!names.is_array() || names.empty() || names.size() > kMaxPatches)
      fail("surfaces", fmt::format("is not a list of 1 to {} names", kMaxPatches));
    for (const json& name : names) {
      if (!name.is_string()) fail("surfaces", "holds something else than names");
      model.surfaces.push_back(name);
    }
    const json& edge = member(object, "longest_edge_m");
    if (!edge.is_number() || !(edge.get<double>() >= 0.0 && edge.get<double>() <= 1e9))
      fail("longest_edge_m", "is no length");
    model.longest_edge_m = edge;
    read_vertices(object, model);
    const std::size_t count = size(object, "patches", 1, kMaxPatches);
    const auto corners = indices(object, "patch_vertices", 3 * count, model.vertices.size());
    const auto surfaces = indices(object, "patch_surface", count, model.surfaces.size());
    for (std::size_t i = 0; i < count; ++i) {
      model.patches.push_back(pipeline::make_patch(
          model, {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]}, surfaces[i]));
      if (!(model.patches.back().area_m2 > 0.0))
        fail("patch_vertices", fmt::format("patch {} has no area", i));
    }
    read_distant(object, model);
  }

  void read_distant(const json& object, pipeline::PatchModel& model) const {
    const std::size_t count =
        size(object, "distant_patches", 0, std::min<std::size_t>(1, model.patches.size() - 1));
    for (std::size_t i = 0; i < count; ++i)
      model.patches[model.patches.size() - 1 - i].distant = true;
    const json& clear = member(object, "clear_surfaces");
    if (!clear.is_array() || clear.size() > model.surfaces.size())
      fail("clear_surfaces", "is not a list of surfaces");
    for (const json& surface : clear) {
      if (!surface.is_number_unsigned() || surface.get<std::uint64_t>() >= model.surfaces.size())
        fail("clear_surfaces", fmt::format("{} is no surface's number", surface.dump()));
      model.clear_surfaces.push_back(surface.get<std::uint32_t>());
    }
  }

  void read_vertices(const json& object, pipeline::PatchModel& model) const {
    const std::size_t count = size(object, "vertices", 3, 3 * kMaxPatches);
    // Far enough for any scene, and near enough that areas stay finite.
    const auto positions = vectors(object, "positions_m", count, -1e9f, 1e9f);
    const auto normals = vectors(object, "normals", count, -1.001f, 1.001f);
    for (std::size_t i = 0; i < count; ++i) {
      if (std::abs(glm::length(normals[i]) - 1.0f) > 1e-3f)
        fail("normals",
             fmt::format("normal {} has length {:g}, not 1", i, glm::length(normals[i])));
      model.vertices.push_back({positions[i], normals[i]});
    }
  }

  void read_tone(pipeline::ToneCurve& tone) const {
    const std::vector<float> values = floats(root_, "tone", 3 * 256, 0.0f, kLargest);
    for (std::size_t i = 0; i < values.size(); ++i) {
      tone.radiance_from_value[i / 256][i % 256] = values[i];
      if (i % 256 != 0 && !(values[i] > values[i - 1]))
        fail("tone", fmt::format("number {} does not rise", i));
    }
  }

  void read_probe(pipeline::DirectionMap& probe) const {
    const json& object = member(root_, "probe");
    probe.width = static_cast<int>(size(object, "width", 1, kMaxMapSide));
    probe.height = static_cast<int>(size(object, "height", 1, kMaxMapSide));
    probe.center = vectors(object, "center_m", 1, -1e9f, 1e9f).front();
    probe.radiance = vectors(object, "radiance",
                             static_cast<std::size_t>(probe.width) * probe.height, 0.0f, kLargest);
  }

  std::string name_;
  json root_;
};

}  // namespace

void write_lit_scene(const fs::path& file, const pipeline::LitScene& scene) {
  const pipeline::DirectionMap& probe = scene.probe;
  raster::require(scene.radiance.size() == scene.model.patches.size() &&
                      scene.reflectance.size() == scene.model.patches.size(),
                  "each patch has a radiance and a reflectance");
  raster::require(probe.radiance.size() == static_cast<std::size_t>(probe.width) * probe.height,
                  "a map's radiance fits its size");
  std::vector<float> tone;
  for (const auto& channel : scene.tone.radiance_from_value)
    tone.insert(tone.end(), channel.begin(), channel.end());
  const ordered_json root{{"format", kFormat},
                          {"version", kVersion},
                          {"model", model_json(scene.model)},
                          {"radiance", base64_of(scene.radiance)},
                          {"reflectance", base64_of(scene.reflectance)},
                          {"tone", base64_from_floats(tone)},
                          {"probe",
                           {{"width", probe.width},
                            {"height", probe.height},
                            {"center_m", base64_of({probe.center})},
                            {"radiance", base64_of(probe.radiance)}}}};
  const std::string text = root.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
  if (text.size() > kMaxLitSceneBytes)
    throw InputError(fmt::format("{}: would have {} bytes, more than the {} that are read",
                                 one_line(file.string()), text.size(), kMaxLitSceneBytes));
  write_file(file, text);
}

pipeline::LitScene read_lit_scene(const fs::path& file) { return Reader(file).read(); }

}  // namespace gnomon::ar
