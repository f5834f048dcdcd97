#include "ar/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <set>

#include "ar/differential_keys.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/gltf.h"
#include "ar/map_keys.h"
#include "ar/toml_pose.h"
#include "ar/toml_table.h"
#include "raster/frame.h"

namespace gnomon::ar {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxSceneBytes = 1 << 20;
constexpr int kMaxTagNumber = 1'000'000;
constexpr int kMaxSamples = 1024;
constexpr int kMaxGroupDepth = 200;
class SceneReader {
 public:
  explicit SceneReader(const fs::path& path) { scene_.file = path; }

  SceneFile read() {
    const toml::table root = load_toml(scene_.file, kMaxSceneBytes, kSceneFormat);
    const TomlTable top(
        scene_.file, root, "",
        {"format", "ambient", "lighting", "camera", "detection", "dictionary", "tag", "tags_yaml",
         "body", "group", "object", "light", "caster", "shadow", "differential", "filter"});
    if (const auto ambient = top.vector("ambient", 0.0, 1.0)) scene_.ambient = *ambient;
    read_lighting(top);
    read_camera_table(top);
    for (const toml::table* t : top.tables("dictionary")) read_dictionary(*t);
    read_detection(top);
    for (const toml::table* t : top.tables("tag"))
      scene_.tags.world.tags.push_back(read_tag(*t, "tag", "world_from_tag"));
    for (const toml::table* t : top.tables("body")) read_body(*t);
    read_tags_yaml_table(top);
    for (const toml::table* t : top.tables("group")) read_group(*t);
    for (const toml::table* t : top.tables("object")) read_object(*t);
    for (const toml::table* t : top.tables("light")) read_light(*t);
    for (const toml::table* t : top.tables("caster")) read_caster(*t);
    read_shadow(top);
    if (const toml::table* table = top.table("differential"))
      scene_.differential = read_differential(scene_.file, *table);
    read_filter(top);
    check_whole(root);
    return std::move(scene_);
  }

 private:
  /// "[object 'torus']" once the name is known.
  std::string place_of(const toml::table& table, const std::string& kind) const {
    const std::optional<std::string> name = table["name"].value<std::string>();
    return name ? fmt::format("[{} '{}']", kind, name->substr(0, 80)) : fmt::format("[{}]", kind);
  }

  std::string unique_name(const TomlTable& t, std::set<std::string>& names) {
    std::string name = t.required("name", t.text("name"));
    if (!names.insert(name).second) t.fail("name", fmt::format("'{}' is used twice", name));
    return name;
  }

  void read_lighting(const TomlTable& top) {
    const std::string lighting = top.text("lighting").value_or("pixel");
    if (lighting != "pixel" && lighting != "vertex")
      top.fail("lighting", fmt::format("'{}' is not one of pixel, vertex", lighting));
    scene_.vertex_lighting = lighting == "vertex";
  }

  void read_camera_table(const TomlTable& top) {
    const toml::table* table = top.table("camera");
    if (table == nullptr) return;
    const TomlTable t(scene_.file, *table, "[camera]",
                      {"file", "width", "height", "fov_y_deg", "near_m", "far_m",
                       "world_from_camera", "axes", "eye_m", "target_m", "up", "samples"});
    for (const char* key : {"fov_y_deg", "width", "height"})
      if (t.has("file") && t.has(key)) t.fail(key, "together with file, which says it");
    if (t.has("fov_y_deg") || !t.has("file"))
      scene_.pinhole = read_pinhole(t);
    else
      scene_.camera_file = *t.file("file");
    scene_.near_m = t.number("near_m", 1e-4, kMaxMetres).value_or(scene_.near_m);
    scene_.far_m = t.number("far_m", 1e-3, kMaxMetres).value_or(scene_.far_m);
    if (scene_.far_m <= scene_.near_m)
      t.fail(t.has("far_m") ? "far_m" : "near_m",
             fmt::format("far_m {} is not beyond near_m {}", scene_.far_m, scene_.near_m));
    scene_.samples = t.integer("samples", 1, 8).value_or(0);
    read_camera_pose(t);
  }

  static CameraModel read_pinhole(const TomlTable& t) {
    if (!t.has("fov_y_deg")) t.fail("file", "missing: give file, or fov_y_deg with width, height");
    const int width = t.integer("width", 1, raster::kMaxTargetSize).value_or(640);
    const int height = t.integer("height", 1, raster::kMaxTargetSize).value_or(480);
    const double fov = glm::radians(*t.number("fov_y_deg", 1.0, 170.0));
    return pinhole_camera(width, height, focal_for(height, fov));
  }

  void read_camera_pose(const TomlTable& t) {
    const bool looks = t.has("eye_m") || t.has("target_m") || t.has("up");
    if (looks && t.has("world_from_camera"))
      t.fail("world_from_camera", "together with eye_m and target_m: give one of them");
    if (t.has("axes") && !t.has("world_from_camera")) t.fail("axes", "without world_from_camera");
    if (looks) scene_.world_from_camera = read_look_at(t);
    if (!t.has("world_from_camera")) return;
    scene_.world_from_camera = read_world_from_camera(t);
  }

  void read_dictionary(const toml::table& table) {
    const TomlTable t(scene_.file, table, place_of(table, "dictionary"), {"name", "file"});
    const std::string name = unique_name(t, dictionary_names_);
    const std::vector<std::string> known = known_families();
    if (std::find(known.begin(), known.end(), name) != known.end())
      t.fail("name", fmt::format("'{}' is a family that needs no file", name));
    scene_.dictionaries.push_back({name, t.required("file", t.file("file"))});
  }

  void check_family(const TomlTable& t, std::string_view key, const std::string& family) {
    if (dictionary_names_.contains(family)) return;
    static const std::vector<std::string> kKnown = known_families();
    if (std::find(kKnown.begin(), kKnown.end(), family) == kKnown.end())
      t.fail(key, fmt::format("'{}' is neither a tag family that is known nor a [[dictionary]]",
                              family));
  }

  void use_family(const std::string& family) {
    auto& families = scene_.families;
    if (!families_given_ && std::find(families.begin(), families.end(), family) == families.end())
      families.push_back(family);
  }

  void read_detection(const TomlTable& top) {
    const toml::table* table = top.table("detection");
    if (table == nullptr) return;
    const TomlTable t(scene_.file, *table, "[detection]", {"families", "response", "gamma"});
    if (const auto families = t.texts("families")) {
      for (const std::string& family : *families) check_family(t, "families", family);
      scene_.families = *families;
      families_given_ = true;
    }
    scene_.response_file = t.file("response");
    scene_.gamma = t.number("gamma", 0.1, 10.0);
    if (scene_.response_file && scene_.gamma)
      t.fail("gamma", "together with response: give one of them");
  }

  PlacedTag read_tag(const toml::table& table, const std::string& place,
                     std::string_view matrix_key) {
    const TomlTable t(
        scene_.file, table, fmt::format("[{}]", place),
        {"family", "id", "size_m", matrix_key, "position_m", "rotation_deg", "quaternion"});
    PlacedTag tag;
    tag.id.family = t.required("family", t.text("family"));
    check_family(t, "family", tag.id.family);
    if (families_given_ && std::find(scene_.families.begin(), scene_.families.end(),
                                     tag.id.family) == scene_.families.end())
      t.fail("family", fmt::format("'{}' is not among the families of [detection]", tag.id.family));
    use_family(tag.id.family);
    tag.id.number = t.required("id", t.integer("id", 0, kMaxTagNumber));
    if (!tags_.insert(tag.id).second)
      t.fail("id", fmt::format("tag {} of {} is used twice", tag.id.number, tag.id.family));
    tag.size_m = t.required("size_m", t.number("size_m", 1e-4, 1e3));
    tag.body_from_tag = read_pose(t, matrix_key, false);
    return tag;
  }

  void read_body(const toml::table& table) {
    const TomlTable t(scene_.file, table, place_of(table, "body"), {"name", "tag"});
    TaggedBody body;
    body.name = unique_name(t, body_names_);
    if (body.name == "world") t.fail("name", "'world' is not a body: use [[tag]]");
    for (const toml::table* tag : t.tables("tag"))
      body.tags.push_back(read_tag(*tag, fmt::format("body '{}' tag", body.name), "body_from_tag"));
    if (body.tags.empty()) t.fail("tag", "missing: a body has one tag at least");
    scene_.tags.bodies.push_back(std::move(body));
  }

  void read_tags_yaml_table(const TomlTable& top) {
    const toml::table* table = top.table("tags_yaml");
    if (table == nullptr) return;
    const TomlTable t(scene_.file, *table, "[tags_yaml]", {"file", "family", "world"});
    TagsYaml yaml;
    yaml.file = t.required("file", t.file("file"));
    yaml.family = t.text("family").value_or("tag36h11");
    check_family(t, "family", yaml.family);
    use_family(yaml.family);
    yaml.world = t.text("world").value_or("");
    scene_.tags_yaml = yaml;
  }

  /// The body or group that a thing hangs on; empty for the world.
  std::string read_attachment(const TomlTable& t) const {
    const std::string to = t.text("attached_to").value_or("world");
    // A tags.yaml brings bodies of its own.
    if (to != "world" && !body_names_.contains(to) && !group_names_.contains(to) &&
        !scene_.tags_yaml)
      t.fail("attached_to",
             fmt::format("'{}' is neither world nor a [[body]] nor a [[group]] above", to));
    return to == "world" ? "" : to;
  }

  void read_group(const toml::table& table) {
    const TomlTable t(scene_.file, table, place_of(table, "group"),
                      {"name", "attached_to", "parent_from_group", "position_m", "rotation_deg",
                       "quaternion", "scale"});
    SceneGroup group;
    // Before its own name is known: a group does not hang on itself, nor on one below it.
    group.attached_to = read_attachment(t);
    group.name = unique_name(t, group_names_);
    if (group.name == "world" || body_names_.contains(group.name))
      t.fail("name", fmt::format("'{}' is the world's or a [[body]]'s", group.name));
    const auto above = group_depths_.find(group.attached_to);
    const int depth = above == group_depths_.end() ? 1 : above->second + 1;
    if (depth > kMaxGroupDepth)
      t.fail("attached_to", fmt::format("lies more than {} groups deep", kMaxGroupDepth));
    group_depths_[group.name] = depth;
    group.parent_from_group = read_pose(t, "parent_from_group", true);
    scene_.groups.push_back(std::move(group));
  }

  void read_object(const toml::table& table) {
    const std::string on = table["attached_to"].value<std::string>().value_or("world");
    const std::string_view matrix_key = on == "world"               ? "world_from_object"
                                        : group_names_.contains(on) ? "group_from_object"
                                                                    : "body_from_object";
    const TomlTable t(
        scene_.file, table, place_of(table, "object"),
        {"name", "role", "model", "shadow_model", "shadow_displace_m", "attached_to", matrix_key,
         "position_m", "rotation_deg", "quaternion", "scale", "casts", "receives"});
    SceneObject object;
    object.name = unique_name(t, object_names_);
    const std::string role = t.required("role", t.text("role"));
    if (role != "virtual" && role != "phantom")
      t.fail("role", fmt::format("'{}' is not one of virtual, phantom", role));
    object.role = role == "phantom" ? pipeline::Role::phantom : pipeline::Role::virtual_object;
    object.model = t.required("model", t.file("model"));
    object.attached_to = read_attachment(t);
    object.body_from_object = read_pose(t, matrix_key, true);
    object.casts = t.boolean("casts").value_or(true);
    object.receives = t.boolean("receives").value_or(true);
    if (const auto shadow_model = t.file("shadow_model")) {
      if (!object.casts) t.fail("shadow_model", "together with casts = false");
      object.shadow_model = *shadow_model;
      object.shadow_model_line = table.get("shadow_model")->source().begin.line;
    } else if (t.has("shadow_displace_m")) {
      t.fail("shadow_displace_m", "without shadow_model");
    }
    object.shadow_displace_m = t.number("shadow_displace_m", 0.0, kMaxMetres);
    scene_.objects.push_back(std::move(object));
  }

  glm::vec4 read_light_position(const TomlTable& t) {
    const int given = (t.has("position_m") ? 1 : 0) + (t.has("direction_towards") ? 1 : 0) +
                      (t.has("node") ? 1 : 0);
    if (given != 1)
      t.fail(given == 0      ? "position_m"
             : t.has("node") ? "node"
                             : "direction_towards",
             "give one of position_m, direction_towards, node (with model)");
    if (t.has("model") && !t.has("node")) t.fail("model", "without node");
    if (const auto position = t.vector("position_m", -kMaxMetres, kMaxMetres))
      return {glm::vec3(*position), 1.0f};
    if (const auto direction = t.vector("direction_towards", -kMaxMetres, kMaxMetres)) {
      if (!(glm::length(*direction) > 1e-9)) t.fail("direction_towards", "has no length");
      return {glm::vec3(glm::normalize(*direction)), 0.0f};
    }
    const std::string name = t.required("node", t.text("node"));
    const fs::path model = t.required("model", t.file("model"));
    scene_.light_models.push_back(model);
    for (const GltfNode& node : read_gltf_nodes(model))
      if (node.name == name) return {glm::vec3(node.center_m), 1.0f};
    t.fail("node", fmt::format("no node '{}' in {}", name, model.string()));
  }

  void read_light(const toml::table& table) {
    const TomlTable t(scene_.file, table, place_of(table, "light"),
                      {"name", "position_m", "direction_towards", "node", "model", "color", "share",
                       "radius_m", "radius_deg", "samples", "attenuation", "attached_to",
                       "spot_deg", "spot_direction", "spot_exponent"});
    pipeline::Light light;
    light.name = unique_name(t, light_names_);
    light.position = read_light_position(t);
    const bool directional = light.position.w == 0.0f;
    light.color = t.vector("color", 0.0, 100.0).value_or(glm::dvec3(1.0));
    light.share = static_cast<float>(t.number("share", 0.0, 1.0).value_or(0.5));
    if (t.has(directional ? "radius_m" : "radius_deg"))
      t.fail(directional ? "radius_m" : "radius_deg", directional
                                                          ? "a light at infinity has radius_deg"
                                                          : "a light in the room has radius_m");
    const double radius = directional
                              ? glm::radians(t.number("radius_deg", 0.0, 60.0).value_or(0.0))
                              : t.number("radius_m", 0.0, 1e3).value_or(0.0);
    light.radius = static_cast<float>(radius);
    light.samples = t.integer("samples", 1, kMaxSamples).value_or(1);
    if (const auto attenuation = t.vector("attenuation", 0.0, 1e6)) {
      if (directional) t.fail("attenuation", "a light at infinity has none");
      if (*attenuation == glm::dvec3(0.0)) t.fail("attenuation", "is 0 throughout");
      light.attenuation = *attenuation;
    }
    read_spot(t, light);
    scene_.light_attached_to.push_back(read_attachment(t));
    scene_.lights.push_back(std::move(light));
  }

  static void read_spot(const TomlTable& t, pipeline::Light& light) {
    if (!t.has("spot_deg")) {
      for (const char* key : {"spot_direction", "spot_exponent"})
        if (t.has(key)) t.fail(key, "without spot_deg");
      return;
    }
    if (light.position.w == 0.0f) t.fail("spot_deg", "a light at infinity is no spot");
    light.spot_cos_cutoff =
        static_cast<float>(std::cos(glm::radians(*t.number("spot_deg", 0.1, 90.0))));
    const glm::dvec3 direction =
        t.required("spot_direction", t.vector("spot_direction", -kMaxMetres, kMaxMetres));
    if (!(glm::length(direction) > 1e-9)) t.fail("spot_direction", "has no length");
    light.spot_direction = glm::vec3(glm::normalize(direction));
    light.spot_exponent = t.integer("spot_exponent", 0, 128).value_or(0);
  }

  void read_caster(const toml::table& table) {
    const TomlTable t(scene_.file, table, "[caster]",
                      {"node", "light", "method", "size", "sides", "fov_deg", "near_m", "far_m",
                       "displace_scale", "displace_offset", "filter", "depth_bits"});
    SceneCaster caster;
    caster.node = t.text("node").value_or("");
    const bool object = object_names_.contains(caster.node);
    const bool carrier = group_names_.contains(caster.node) || body_names_.contains(caster.node);
    if (object && carrier)
      t.fail("node",
             fmt::format("'{}' is an [[object]] and also a [[group]] or [[body]]", caster.node));
    // A tags.yaml brings bodies of its own.
    if (!caster.node.empty() && !object && !carrier && !scene_.tags_yaml)
      t.fail("node", fmt::format("'{}' is no [[object]], [[group]] or [[body]]", caster.node));
    caster.light = t.text("light").value_or("");
    if (!caster.light.empty() && !light_names_.contains(caster.light))
      t.fail("light", fmt::format("'{}' is no [[light]]", caster.light));
    caster.method = read_shadow_method(t);
    caster.map = read_map_settings(t, caster.method);
    scene_.casters.push_back(std::move(caster));
  }

  void read_shadow(const TomlTable& top) {
    const toml::table* table = top.table("shadow");
    if (table == nullptr) return;
    const TomlTable t(scene_.file, *table, "[shadow]", {"method", "volume", "double_shadows"});
    const std::string method = t.text("method").value_or("auto");
    if (method == "zpass")
      scene_.shadow.method = ShadowMethod::zpass;
    else if (method == "zfail")
      scene_.shadow.method = ShadowMethod::zfail;
    else if (method != "auto")
      t.fail("method", fmt::format("'{}' is not one of auto, zpass, zfail", method));
    if (const toml::node* volume = table->get("volume"); volume && volume->is_string()) {
      const std::string text = *t.text("volume");
      if (text == "infinite")
        scene_.shadow.volume = InfiniteReach{};
      else if (text != "auto")
        t.fail("volume", fmt::format("'{}' is not auto, infinite or a number of metres", text));
    } else if (volume != nullptr) {
      scene_.shadow.volume = *t.number("volume", 1e-3, kMaxMetres);
    }
    scene_.shadow.double_shadows = t.boolean("double_shadows").value_or(false);
  }

  void read_filter(const TomlTable& top) {
    const toml::table* table = top.table("filter");
    if (table == nullptr) return;
    const TomlTable t(scene_.file, *table, "[filter]",
                      {"on", "min_cutoff_hz", "beta_per_m", "beta_per_rad", "speed_cutoff_hz"});
    FilterSettings& filter = scene_.filter;
    filter.on = t.boolean("on").value_or(filter.on);
    filter.min_cutoff_hz = t.number("min_cutoff_hz", 1e-3, 1e3).value_or(filter.min_cutoff_hz);
    filter.beta_per_m = t.number("beta_per_m", 0.0, 1e6).value_or(filter.beta_per_m);
    filter.beta_per_rad = t.number("beta_per_rad", 0.0, 1e6).value_or(filter.beta_per_rad);
    filter.speed_cutoff_hz =
        t.number("speed_cutoff_hz", 1e-3, 1e3).value_or(filter.speed_cutoff_hz);
  }

  void check_whole(const toml::table& root) {
    if (scene_.objects.empty()) fail_at(scene_.file, root, "object: missing: nothing to draw");
    if (scene_.lights.empty() && !scene_.differential)
      fail_at(scene_.file, root, "light: missing: no light, no shadow");
  }

  SceneFile scene_;
  bool families_given_ = false;
  std::set<std::string> dictionary_names_, body_names_, group_names_, object_names_, light_names_;
  std::map<std::string, int> group_depths_;
  std::set<TagId> tags_;
};

}  // namespace

SceneFile read_scene(const fs::path& path) { return SceneReader(path).read(); }

void require_photograph(const SceneFile& scene) {
  const std::string file = one_line(scene.file.string());
  if (scene.camera_file.empty() && !scene.pinhole)
    throw InputError(fmt::format("{}: camera: missing", file));
  const bool tags = !scene.tags.world.tags.empty() || !scene.tags.bodies.empty();
  if (!scene.world_from_camera && !tags && !scene.tags_yaml)
    throw InputError(fmt::format(
        "{}: tag: missing: without tags the camera needs [camera].world_from_camera", file));
}

std::vector<fs::path> input_files(const SceneFile& scene) {
  std::vector<fs::path> files{scene.file};
  if (!scene.camera_file.empty()) files.push_back(scene.camera_file);
  if (scene.response_file) files.push_back(*scene.response_file);
  if (scene.tags_yaml) files.push_back(scene.tags_yaml->file);
  if (scene.differential && !scene.differential->lit_scene.empty())
    files.push_back(scene.differential->lit_scene);
  for (const CustomDictionary& dictionary : scene.dictionaries) files.push_back(dictionary.file);
  for (const SceneObject& object : scene.objects) {
    files.push_back(object.model);
    if (!object.shadow_model.empty()) files.push_back(object.shadow_model);
  }
  files.insert(files.end(), scene.light_models.begin(), scene.light_models.end());
  return files;
}

}  // namespace gnomon::ar
