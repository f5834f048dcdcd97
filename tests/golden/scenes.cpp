#include "golden/scenes.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "ar/camera.h"
#include "ar/pinhole_view.h"
#include "ar/scene_file.h"
#include "ar/scene_models.h"
#include "golden/box.h"
#include "pipeline/general_method.h"
#include "pipeline/haller.h"
#include "raster/check.h"
#include "raster/random_frames.h"

namespace gnomon::golden {
namespace {

using pipeline::VolumeMethod;
using raster::ColorFormat;
using raster::DepthFormat;

/// What a recorded frame of a shadow method borrows.
struct World {
  pipeline::Scene scene;
  pipeline::Camera camera;
  std::vector<std::uint8_t> picture;
};

/// A desk scene as its file says, seen by its camera without the lens. The picture's shape is
/// stretched to the size: every size sees all of it.
std::shared_ptr<World> desk_world(const std::string& name, Size size) {
  const ar::SceneFile file = ar::read_scene(std::filesystem::path(GNOMON_SOURCE_DIR) /
                                            "tests/data/desk" / name / "true_light.toml");
  auto world = std::make_shared<World>();
  const auto models = ar::load_models(file);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const ar::SceneObject& object = file.objects[i];
    world->scene.objects.push_back({object.name, object.role, models[i].model,
                                    glm::mat4(object.body_from_object), object.casts,
                                    object.receives});
  }
  world->scene.lights = file.lights;
  world->scene.ambient = file.ambient;

  ar::CameraModel camera = ar::read_camera(file.camera_file);
  const double sx = static_cast<double>(size.width) / camera.width;
  const double sy = static_cast<double>(size.height) / camera.height;
  camera = {.width = size.width,
            .height = size.height,
            .fx = camera.fx * sx,
            .fy = camera.fy * sy,
            .cx = (camera.cx + 0.5) * sx - 0.5,
            .cy = (camera.cy + 0.5) * sy - 0.5};
  raster::require(file.world_from_camera.has_value(), "a desk scene has a fixed camera");
  world->camera =
      ar::PinholeView(ar::Lens(camera), 1).camera(*file.world_from_camera, file.near_m, file.far_m);
  return world;
}

/// In the photograph's place: a ramp in each channel, top row first, no two alike.
std::vector<std::uint8_t> ramps(Size size) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      pixels.push_back(static_cast<std::uint8_t>(96 + 128 * x / size.width));
      pixels.push_back(static_cast<std::uint8_t>(112 + 96 * y / size.height));
      pixels.push_back(static_cast<std::uint8_t>(224 - 96 * x / size.width));
    }
  return pixels;
}

struct Desk {
  const char* name;
  pipeline::HallerOptions options;
  std::vector<pipeline::Light> more_lights = {};
};

raster::RecordedFrame record_desk(const Desk& desk, Size size, Formats formats) {
  raster::RecordedFrame out;
  const raster::Targets targets = add_targets(out, size, formats);
  const std::shared_ptr<World> world = desk_world(desk.name, size);
  for (const pipeline::Light& light : desk.more_lights) world->scene.lights.push_back(light);
  world->picture = ramps(size);
  out.frame = pipeline::record_haller(
      world->scene, world->camera,
      raster::ImageView::from_top_row(world->picture.data(), size.width, size.height, 3), targets,
      desk.options);
  out.frame.keep(world);
  return out;
}

Scene desk_scene(std::string name, Size size, Desk desk, Formats formats = {}) {
  return {.name = std::move(name), .record = [=] { return record_desk(desk, size, formats); }};
}

/// A window at infinity and a lamp of some size beside the bulb.
std::vector<pipeline::Light> window_and_lamp() {
  return {{.name = "window",
           .position = {-0.48f, 0.6f, 0.64f, 0.0f},
           .color = {0.2f, 0.25f, 0.3f},
           .share = 0.2f},
          {.name = "lamp",
           .position = {-0.4f, 1.6f, -0.9f, 1.0f},
           .color = {0.3f, 0.25f, 0.15f},
           .share = 0.2f,
           .radius = 0.05f,
           .samples = 3}};
}

pipeline::Object boxed(std::string name, const glm::vec3& half, const glm::vec3& at, float sine,
                       const glm::vec3& diffuse, std::shared_ptr<const raster::Texture> texture) {
  auto model = std::make_shared<pipeline::Model>();
  raster::Material material;
  material.ambient = material.diffuse = diffuse;
  material.specular = glm::vec3(0.4f);
  material.shininess = 20;
  model->parts.push_back({.mesh = box(half), .material = material, .texture = std::move(texture)});
  // Turned about y and then about x by an angle given by its sine, so that no library's cosine is
  // asked.
  const float cosine = std::sqrt(1.0f - sine * sine);
  const glm::mat4 about_y{{cosine, 0, -sine, 0}, {0, 1, 0, 0}, {sine, 0, cosine, 0}, {0, 0, 0, 1}};
  const glm::mat4 about_x{{1, 0, 0, 0}, {0, cosine, sine, 0}, {0, -sine, cosine, 0}, {0, 0, 0, 1}};
  const glm::mat4 moved{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {at, 1.0f}};
  return {.name = std::move(name),
          .model = std::move(model),
          .world_from_model = moved * about_y * about_x};
}

/// Three turned boxes above a plate; the lights are a point and, if asked for, a direction.
raster::RecordedFrame record_boxes(const pipeline::GeneralOptions& options, bool two_lights,
                                   Size size, Formats formats) {
  raster::RecordedFrame out;
  const raster::Targets targets = add_targets(out, size, formats);
  auto checks = std::make_shared<raster::Texture>();
  checks->width = checks->height = 2;
  checks->texels = {
      {255, 240, 220, 255}, {90, 80, 70, 255}, {70, 90, 80, 255}, {220, 255, 240, 255}};
  auto world = std::make_shared<World>();
  pipeline::Scene& scene = world->scene;
  scene.objects = {
      boxed("plate", {2.5f, 0.1f, 2.5f}, {0.0f, -0.1f, 0.0f}, 0.0f, glm::vec3(0.8f), checks),
      boxed("red", {0.4f, 0.3f, 0.4f}, {-0.7f, 0.8f, 0.2f}, 0.6f, {0.8f, 0.3f, 0.2f}, nullptr),
      boxed("green", {0.25f, 0.6f, 0.25f}, {0.6f, 0.9f, -0.3f}, 0.28f, {0.3f, 0.7f, 0.3f}, checks),
      boxed("blue", {0.15f, 0.15f, 0.7f}, {0.2f, 1.9f, 0.5f}, -0.8f, {0.3f, 0.4f, 0.9f}, nullptr)};
  scene.lights = {{.name = "lamp", .position = {1.2f, 3.5f, 1.0f, 1.0f}, .color = glm::vec3(0.7f)}};
  if (two_lights)
    scene.lights.push_back(
        {.name = "sky", .position = {-0.6f, 0.8f, 0.0f, 0.0f}, .color = {0.2f, 0.25f, 0.35f}});
  const auto [width, height] = size;
  const ar::CameraModel lens{.width = width,
                             .height = height,
                             .fx = 0.9 * width,
                             .fy = 1.2 * height,
                             .cx = 0.5 * width - 0.5,
                             .cy = 0.5 * height - 0.5};
  // From above and in front, OpenCV's axes: a turn of sine 0.6.
  const glm::dmat4 world_from_camera{
      {1, 0, 0, 0}, {0, -0.8, 0.6, 0}, {0, -0.6, -0.8, 0}, {0.1, 3.2, 4.0, 1}};
  world->camera = ar::PinholeView(ar::Lens(lens), 1).camera(world_from_camera, 0.1, 30.0);
  out.frame = pipeline::record_general(scene, world->camera, targets, options);
  out.frame.keep(world);
  return out;
}

Scene boxes_scene(std::string name, Size size, const pipeline::GeneralOptions& options,
                  bool two_lights, Formats formats) {
  return {.name = std::move(name),
          .record = [=] { return record_boxes(options, two_lights, size, formats); },
          .quick = true};
}

Scene random_scene(std::uint32_t seed, Size size, Formats formats) {
  return {.name = "random-" + std::to_string(seed),
          .record =
              [=] {
                raster::RecordedFrame out;
                const raster::Targets targets = add_targets(out, size, formats);
                random_frames::record_pass(out.frame, seed, 60, targets);
                return out;
              },
          .quick = true};
}

void add_desks(std::vector<Scene>& all) {
  const std::map<std::string, const char*> desks{{"desk-01", "01_torus_on_house"},
                                                 {"desk-02", "02_house_on_torus"},
                                                 {"desk-03", "03_tin_on_torus"},
                                                 {"desk-04", "04_torus_and_sphere_on_tin"}};
  constexpr Size kUsual{160, 120};
  // 20 tiles: more than the threads of any test.
  constexpr Size kLarge{320, 240};
  for (const auto& [name, file] : desks) {
    all.push_back(desk_scene(name + "-zpass", kUsual, {file, {.method = VolumeMethod::zpass}}));
    all.push_back(desk_scene(name + "-zfail", kUsual, {file, {.method = VolumeMethod::zfail}}));
  }
  const char* one = desks.at("desk-01");
  const char* four = desks.at("desk-04");
  all.push_back(desk_scene("desk-01-automatic", kLarge, {one, {}}));
  all.push_back(desk_scene("desk-04-automatic", kLarge, {four, {}}));
  for (const Size size : {Size{1, 1}, {7, 5}, {63, 65}, {130, 97}}) {
    all.push_back(
        desk_scene("desk-01-" + std::to_string(size.width) + "x" + std::to_string(size.height),
                   size, {one, {}}));
    all.back().quick = size.width * size.height < 5000;
  }
  all.push_back(desk_scene(
      "desk-01-infinite", kUsual,
      {one, {.method = VolumeMethod::zfail, .extrusion = {pipeline::Extrusion::Kind::infinite}}}));
  all.push_back(desk_scene("desk-01-radius", kUsual,
                           {one, {.extrusion = {pipeline::Extrusion::Kind::radius, 2.0f}}}));
  all.push_back(desk_scene("desk-02-double-shadows", kUsual,
                           {desks.at("desk-02"), {.double_shadows = true}}));
  all.push_back(
      desk_scene("desk-03-appendix-letter", kUsual,
                 {desks.at("desk-03"), {.method = VolumeMethod::zpass, .appendix_letter = true}}));
  all.push_back(
      desk_scene("desk-03-d16", kUsual, {desks.at("desk-03"), {}}, {.depth = DepthFormat::d16}));
  all.push_back(desk_scene("desk-01-three-lights", {130, 97}, {one, {}, window_and_lamp()},
                           {.color = ColorFormat::rgba32f}));
  all.push_back(desk_scene("desk-04-counts", kLarge, {four, {}}));
  all.back().frame_of = "desk-04-automatic";
  all.back().last_pass = pipeline::haller_label::kAllVolumes;
}

std::vector<Scene> make_scenes() {
  std::vector<Scene> all;
  add_desks(all);
  using Method = pipeline::GeneralOptions;
  all.push_back(
      boxes_scene("boxes-zpass", {160, 120}, Method{.method = VolumeMethod::zpass}, false, {}));
  all.push_back(boxes_scene("boxes-zfail", {130, 97}, Method{.method = VolumeMethod::zfail}, false,
                            {.depth = DepthFormat::d16}));
  all.push_back(
      boxes_scene("boxes-two-lights", {63, 65}, Method{}, true, {.color = ColorFormat::rgba32f}));
  all.push_back(boxes_scene("boxes-1280x720", {1280, 720}, Method{}, true, {}));
  all.push_back(random_scene(11, {1, 1}, {}));
  all.push_back(random_scene(12, {7, 5}, {ColorFormat::rgba32f, DepthFormat::d16}));
  all.push_back(random_scene(13, {63, 65}, {.depth = DepthFormat::d16}));
  all.push_back(random_scene(14, {130, 97}, {}));
  all.push_back(random_scene(15, {160, 120}, {.color = ColorFormat::rgba32f}));
  all.push_back(random_scene(16, {640, 480}, {}));
  all.push_back(random_scene(17, {1280, 720}, {}));
  add_shadow_map_scenes(all);
  add_state_scenes(all);
  return all;
}

}  // namespace

raster::Targets add_targets(raster::RecordedFrame& out, Size size, Formats formats) {
  auto& color = out.buffers.emplace_back(std::in_place_type<raster::ColorBuffer>, size.width,
                                         size.height, formats.color);
  auto& depth = out.buffers.emplace_back(std::in_place_type<raster::DepthBuffer>, size.width,
                                         size.height, formats.depth);
  auto& stencil =
      out.buffers.emplace_back(std::in_place_type<raster::StencilBuffer>, size.width, size.height);
  return {&std::get<raster::ColorBuffer>(color), &std::get<raster::DepthBuffer>(depth),
          &std::get<raster::StencilBuffer>(stencil)};
}

std::size_t Scene::commands(const raster::Frame& frame) const {
  if (last_pass.empty()) return std::numeric_limits<std::size_t>::max();
  std::size_t count = 0;
  for (const raster::Pass& pass : frame.passes()) {
    count += pass.commands.size();
    if (pass.label.starts_with(last_pass)) return count;
  }
  raster::require(false, "the frame has the scene's last pass");
  return count;
}

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> kScenes = make_scenes();
  return kScenes;
}

}  // namespace gnomon::golden
