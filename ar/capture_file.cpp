#include "ar/capture_file.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "ar/error.h"
#include "ar/pose.h"
#include "ar/toml_pose.h"
#include "ar/toml_table.h"
#include "ar/yaml_input.h"
#include "pipeline/patch_exchange.h"

namespace gnomon::ar {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxCaptureBytes = 1 << 20;
constexpr double kLongestTimeS = 1e6;

/// A pose as the capture set's JSON files have it: world_from_camera_opencv, four rows.
glm::dmat4 read_pose_node(const fs::path& file, const YAML::Node& parent,
                          const std::string& place) {
  constexpr const char* kKey = "world_from_camera_opencv";
  const YAML::Node rows = parent[kKey];
  const std::string key = place + kKey;
  if (!rows.IsDefined() || !rows.IsSequence() || rows.size() != 4)
    yaml::fail(file, rows, key, "expected 4 rows of 4 numbers");
  glm::dmat4 m(1.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const std::vector<double> row = yaml::numbers(file, rows[r], fmt::format("{}[{}]", key, r), 4);
    if (row.size() != 4) yaml::fail(file, rows[r], key, "expected 4 rows of 4 numbers");
    for (std::size_t c = 0; c < 4; ++c) m[static_cast<int>(c)][static_cast<int>(r)] = row[c];
  }
  if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0 ||
      !is_rotation(glm::dmat3(m)))
    yaml::fail(file, rows, key, "is not a rotation and translation");
  return m;
}

/// The pose under pose_file, or under world_from_camera (with axes), or from eye_m and target_m.
glm::dmat4 read_camera_pose(const TomlTable& t) {
  const bool looks = t.has("eye_m") || t.has("target_m") || t.has("up");
  const int ways =
      (t.has("pose_file") ? 1 : 0) + (t.has("world_from_camera") ? 1 : 0) + (looks ? 1 : 0);
  if (ways == 0) t.fail("world_from_camera", "missing: give it, pose_file, or eye_m and target_m");
  if (ways > 1)
    t.fail(t.has("pose_file") ? "pose_file" : "world_from_camera",
           "more than one pose: give pose_file, world_from_camera, or eye_m and target_m");
  if (t.has("axes") && !t.has("world_from_camera")) t.fail("axes", "without world_from_camera");
  if (looks) return read_look_at(t);
  if (t.has("world_from_camera")) return read_world_from_camera(t);
  const fs::path file = *t.file("pose_file");
  return read_pose_node(file, yaml::load(file), "");
}

/// One number, or one a channel.
glm::dvec3 read_reflectance(const toml::table& table, const TomlTable& t) {
  constexpr double kLeast = 0.01;
  if (const toml::node* node = table.get("reflectance"); node != nullptr && node->is_array())
    return *t.vector("reflectance", kLeast, 1.0);
  return glm::dvec3(t.required("reflectance", t.number("reflectance", kLeast, 1.0)));
}

class Reader {
 public:
  explicit Reader(const fs::path& folder) { capture_.file = folder / kCaptureName; }

  CaptureFile read() {
    std::error_code error;
    if (!fs::is_directory(capture_.file.parent_path(), error))
      throw InputError(
          fmt::format("{}: no folder of this name", capture_.file.parent_path().string()));
    const toml::table root = load_toml(capture_.file, kMaxCaptureBytes, kCaptureFormat);
    const TomlTable top(capture_.file, root, "",
                        {"format", "camera", "patches", "photograph", "probe", "sun", "model"});
    capture_.camera = top.required("camera", top.file("camera"));
    capture_.patches =
        top.integer("patches", 1, static_cast<int>(pipeline::PatchExchange::kMostPatches))
            .value_or(capture_.patches);
    read_photograph(required(top, "photograph"));
    read_probe(required(top, "probe"));
    if (const toml::table* sun = top.table("sun")) read_sun(*sun);
    read_model(required(top, "model"));
    return std::move(capture_);
  }

 private:
  static const toml::table& required(const TomlTable& top, std::string_view key) {
    const toml::table* table = top.table(key);
    if (table == nullptr) top.fail(key, fmt::format("missing: write [{}]", key));
    return *table;
  }

  void read_photograph(const toml::table& table) {
    const TomlTable t(capture_.file, table, "[photograph]",
                      {"file", "brackets", "exposure_time_s", "pose_file", "world_from_camera",
                       "axes", "eye_m", "target_m", "up"});
    capture_.photograph = t.required("file", t.file("file"));
    capture_.photograph_brackets = t.required("brackets", t.file("brackets"));
    capture_.exposure_time_s = t.number("exposure_time_s", 1e-9, kLongestTimeS);
    capture_.world_from_camera = read_camera_pose(t);
  }

  void read_probe(const toml::table& table) {
    if (table.contains("latlong"))
      read_latlong(table);
    else if (table.contains("file"))
      read_ball_file(table);
    else
      read_ball(table);
  }

  void read_ball(const toml::table& table) {
    const TomlTable t(capture_.file, table, "[probe]",
                      {"brackets", "center_m", "radius_m", "reflectance", "pose_file",
                       "world_from_camera", "axes", "eye_m", "target_m", "up"});
    BallProbe probe;
    probe.brackets = t.required("brackets", t.file("brackets"));
    probe.ball.center_m = t.required("center_m", t.vector("center_m", -kMaxMetres, kMaxMetres));
    probe.ball.radius_m = t.required("radius_m", t.number("radius_m", 1e-4, 1e3));
    probe.ball.reflectance = read_reflectance(table, t);
    probe.world_from_camera = read_camera_pose(t);
    check_outside(t, probe);
    capture_.probe = probe;
  }

  void read_ball_file(const toml::table& table) {
    const TomlTable t(capture_.file, table, "[probe]", {"brackets", "file"});
    BallProbe probe;
    probe.brackets = t.required("brackets", t.file("brackets"));
    const fs::path file = *t.file("file");
    const YAML::Node root = yaml::load(file);
    const std::vector<double> center = yaml::numbers(file, root["ball_center"], "ball_center", 3);
    if (center.size() != 3)
      yaml::fail(file, root["ball_center"], "ball_center", "expected 3 numbers");
    probe.ball.center_m = {center[0], center[1], center[2]};
    probe.ball.radius_m = yaml::number(file, root["ball_radius"], "ball_radius");
    if (!(probe.ball.radius_m >= 1e-4 && probe.ball.radius_m <= 1e3))
      yaml::fail(file, root["ball_radius"], "ball_radius", "is not within 0.0001 to 1000");
    const double reflectance = yaml::number(file, root["ball_reflectance"], "ball_reflectance");
    if (!(reflectance >= 0.01 && reflectance <= 1.0))
      yaml::fail(file, root["ball_reflectance"], "ball_reflectance", "is not within 0.01 to 1");
    probe.ball.reflectance = glm::dvec3(reflectance);
    const YAML::Node camera = root["camera"];
    if (!camera.IsDefined() || !camera.IsMap())
      yaml::fail(file, camera, "camera", "expected {world_from_camera_opencv}");
    probe.world_from_camera = read_pose_node(file, camera, "camera.");
    check_outside(t, probe);
    capture_.probe = probe;
  }

  static void check_outside(const TomlTable& t, const BallProbe& probe) {
    const double distance =
        glm::length(glm::dvec3(probe.world_from_camera[3]) - probe.ball.center_m);
    if (!(distance > probe.ball.radius_m))
      t.fail(t.has("file") ? "file" : "radius_m",
             fmt::format("the camera is {:g} m from the ball's centre, inside of its radius {:g} m",
                         distance, probe.ball.radius_m));
  }

  void read_latlong(const toml::table& table) {
    const TomlTable t(capture_.file, table, "[probe]", {"latlong", "center_m", "towards", "scale"});
    LatlongProbe probe;
    probe.picture = *t.file("latlong");
    probe.center_m = t.required("center_m", t.vector("center_m", -kMaxMetres, kMaxMetres));
    if (const auto towards = t.vector("towards", -kMaxMetres, kMaxMetres)) {
      const double length = glm::length(*towards);
      if (!(length > 1e-9)) t.fail("towards", "has no length");
      if (std::abs(towards->y) > 1e-6 * length) t.fail("towards", "is not horizontal");
      probe.towards = *towards / length;
    }
    probe.scale = t.vector("scale", 1e-12, 1e12);
    capture_.probe = probe;
  }

  void read_sun(const toml::table& table) {
    const TomlTable t(capture_.file, table, "[sun]", {"direction", "irradiance", "through"});
    CapturedSun sun;
    const glm::dvec3 direction =
        t.required("direction", t.vector("direction", -kMaxMetres, kMaxMetres));
    const double length = glm::length(direction);
    if (!(length > 1e-9)) t.fail("direction", "has no length");
    sun.direction = direction / length;
    sun.irradiance = t.vector("irradiance", 0.0, 1e12);
    sun.through = t.texts("through").value_or(std::vector<std::string>());
    capture_.sun = sun;
  }

  void read_model(const toml::table& table) {
    const TomlTable t(capture_.file, table, "[model]", {"file", "leave_out"});
    capture_.model = t.required("file", t.file("file"));
    capture_.leave_out = t.texts("leave_out").value_or(std::vector<std::string>());
  }

  CaptureFile capture_;
};

}  // namespace

CaptureFile read_capture(const fs::path& folder) { return Reader(folder).read(); }

}  // namespace gnomon::ar
