#include "ar/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <set>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/gltf.h"
#include "ar/model_file.h"
#include "ar/toml_table.h"

namespace gnomon::ar {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxSceneBytes = 1 << 20;
constexpr double kMaxMetres = 1e6;
constexpr int kMaxTagNumber = 1'000'000;
constexpr int kMaxSamples = 1024;
/// Matrices written with six digits are still rotations.
constexpr double kRigidTolerance = 1e-5;

bool is_rotation(const glm::dmat3& r) {
  const glm::dmat3 product = glm::transpose(r) * r;
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k)
      if (std::abs(product[c][k] - (c == k ? 1.0 : 0.0)) > kRigidTolerance) return false;
  return glm::determinant(r) > 0.0;
}

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

/// A pose under `matrix_key`, or from position_m with rotation_deg or quaternion. With `scalable`,
/// the matrix may scale and there may be a scale. Absent keys are the identity.
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

class SceneReader {
 public:
  explicit SceneReader(const fs::path& path) { scene_.file = path; }

  SceneFile read() {
    const std::vector<std::uint8_t> bytes = read_file(scene_.file, kMaxSceneBytes);
    toml::table root;
    try {
      root =
          toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    } catch (const toml::parse_error& e) {
      throw InputError(fmt::format("{}:{}: {}", one_line(scene_.file.string()),
                                   e.source().begin.line, one_line(e.description())));
    }
    // Before the keys: another format has other keys.
    check_format(root);
    const TomlTable top(scene_.file, root, "",
                        {"format", "ambient", "camera", "detection", "dictionary", "tag",
                         "tags_yaml", "body", "object", "light", "shadow", "filter"});
    if (const auto ambient = top.vector("ambient", 0.0, 1.0)) scene_.ambient = *ambient;
    read_camera_table(top);
    for (const toml::table* t : top.tables("dictionary")) read_dictionary(*t);
    read_detection(top);
    for (const toml::table* t : top.tables("tag"))
      scene_.tags.world.tags.push_back(read_tag(*t, "tag", "world_from_tag"));
    for (const toml::table* t : top.tables("body")) read_body(*t);
    read_tags_yaml_table(top);
    for (const toml::table* t : top.tables("object")) read_object(*t);
    for (const toml::table* t : top.tables("light")) read_light(*t);
    read_shadow(top);
    read_filter(top);
    check_whole(root);
    return std::move(scene_);
  }

 private:
  void check_format(const toml::table& root) {
    const toml::node* node = root.get("format");
    if (node == nullptr)
      fail_at(scene_.file, root, fmt::format("format: missing (accepted: \"{}\")", kSceneFormat));
    if (node->value<std::string>() != std::string(kSceneFormat))
      fail_at(scene_.file, *node,
              fmt::format("format: {} is not read (accepted: \"{}\")", shown(*node), kSceneFormat));
  }

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

  void read_camera_table(const TomlTable& top) {
    const toml::table* table = top.table("camera");
    if (table == nullptr) top.fail("camera", "missing");
    const TomlTable t(scene_.file, *table, "[camera]",
                      {"file", "near_m", "far_m", "world_from_camera", "axes"});
    scene_.camera_file = t.required("file", t.file("file"));
    scene_.near_m = t.number("near_m", 1e-4, kMaxMetres).value_or(scene_.near_m);
    scene_.far_m = t.number("far_m", 1e-3, kMaxMetres).value_or(scene_.far_m);
    if (scene_.far_m <= scene_.near_m)
      t.fail(t.has("far_m") ? "far_m" : "near_m",
             fmt::format("far_m {} is not beyond near_m {}", scene_.far_m, scene_.near_m));
    const std::string axes = t.text("axes").value_or("opencv");
    if (axes != "opencv" && axes != "opengl")
      t.fail("axes", fmt::format("'{}' is not one of opencv, opengl", axes));
    if (!t.has("world_from_camera")) {
      if (t.has("axes")) t.fail("axes", "without world_from_camera");
      return;
    }
    glm::dmat4 pose = read_pose(t, "world_from_camera", false);
    if (axes == "opengl") {
      pose[1] = -pose[1];
      pose[2] = -pose[2];
    }
    scene_.world_from_camera = pose;
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

  void read_object(const toml::table& table) {
    const bool on_body = table["attached_to"].value<std::string>().value_or("world") != "world";
    const std::string_view matrix_key = on_body ? "body_from_object" : "world_from_object";
    const TomlTable t(scene_.file, table, place_of(table, "object"),
                      {"name", "role", "model", "attached_to", matrix_key, "position_m",
                       "rotation_deg", "quaternion", "scale", "casts", "receives"});
    SceneObject object;
    object.name = unique_name(t, object_names_);
    const std::string role = t.required("role", t.text("role"));
    if (role != "virtual" && role != "phantom")
      t.fail("role", fmt::format("'{}' is not one of virtual, phantom", role));
    object.role = role == "phantom" ? pipeline::Role::phantom : pipeline::Role::virtual_object;
    object.model = t.required("model", t.file("model"));
    const std::string body = t.text("attached_to").value_or("world");
    // A tags.yaml brings bodies of its own.
    if (body != "world" && !body_names_.contains(body) && !scene_.tags_yaml)
      t.fail("attached_to", fmt::format("'{}' is neither world nor a [[body]]", body));
    if (body != "world") object.attached_to = body;
    object.body_from_object = read_pose(t, matrix_key, true);
    object.casts = t.boolean("casts").value_or(true);
    object.receives = t.boolean("receives").value_or(true);
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
    for (const GltfNode& node : read_gltf_nodes(model))
      if (node.name == name) return {glm::vec3(node.center_m), 1.0f};
    t.fail("node", fmt::format("no node '{}' in {}", name, model.string()));
  }

  void read_light(const toml::table& table) {
    const TomlTable t(scene_.file, table, place_of(table, "light"),
                      {"name", "position_m", "direction_towards", "node", "model", "color", "share",
                       "radius_m", "radius_deg", "samples", "attenuation"});
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
    scene_.lights.push_back(std::move(light));
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
    if (scene_.lights.empty()) fail_at(scene_.file, root, "light: missing: no light, no shadow");
    if (!scene_.world_from_camera && tags_.empty() && !scene_.tags_yaml)
      fail_at(scene_.file, root,
              "tag: missing: without tags the camera needs [camera].world_from_camera");
  }

  SceneFile scene_;
  bool families_given_ = false;
  std::set<std::string> dictionary_names_, body_names_, object_names_, light_names_;
  std::set<TagId> tags_;
};

}  // namespace

SceneFile read_scene(const fs::path& path) { return SceneReader(path).read(); }

std::vector<std::shared_ptr<const pipeline::Model>> load_models(const SceneFile& scene,
                                                                std::vector<std::string>* notes) {
  std::map<fs::path, std::shared_ptr<const pipeline::Model>> read;
  std::vector<std::shared_ptr<const pipeline::Model>> models;
  for (const SceneObject& object : scene.objects) {
    std::error_code error;
    const fs::path canonical = fs::canonical(object.model, error);
    auto& model = read[error ? object.model : canonical];
    if (!model) {
      ModelFile file = load_model(object.model);
      if (notes != nullptr)
        for (const std::string& note : file.notes)
          notes->push_back(fmt::format("{}: {}", object.model.string(), note));
      model = std::make_shared<const pipeline::Model>(std::move(file.model));
    }
    models.push_back(model);
  }
  return models;
}

}  // namespace gnomon::ar
