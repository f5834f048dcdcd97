#include "ar/render_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "ar/buffer_picture.h"
#include "ar/camera.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/pinhole_view.h"
#include "ar/scene_nodes.h"
#include "ar/shadow_settings.h"
#include "ar/stopwatch.h"
#include "pipeline/displaced_caster.h"
#include "pipeline/general_method.h"
#include "pipeline/light_samples.h"
#include "pipeline/modulative_method.h"
#include "pipeline/ray_reference.h"
#include "raster/execute.h"
#include "raster/frame_format.h"

namespace gnomon::ar {

namespace {

constexpr double kFovDeg = 40.0;

/// A ball about everything.
struct Ball {
  glm::dvec3 middle{0.0};
  double radius = 1.0;
};

Ball ball_about(const pipeline::Scene& scene) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  glm::dvec3 low(kInfinity), high(-kInfinity);
  for (const pipeline::Object& object : scene.objects) {
    for (const pipeline::Part& part : object.model->parts) {
      for (const glm::vec4& p : part.mesh.positions) {
        const glm::dvec3 world(object.world_from_model * p);
        if (!std::isfinite(world.x + world.y + world.z)) continue;
        low = glm::min(low, world);
        high = glm::max(high, world);
      }
    }
  }
  if (!(low.x <= high.x)) return {};
  const double radius = 0.5 * glm::length(high - low);
  return {0.5 * (low + high), radius > 0.0 ? radius : 1.0};
}

CameraModel camera_model(const SceneFile& file, int given_width, int given_height) {
  if (!file.camera_file.empty()) {
    CameraModel camera = read_camera(file.camera_file);
    const int width = given_width > 0 ? given_width : camera.width;
    const int height = given_height > 0 ? given_height : camera.height;
    if (width == 0)
      throw InputError(fmt::format("{}: the camera has no picture size: give --size",
                                   one_line(file.camera_file.string())));
    return camera_for_picture(camera, width, height);
  }
  const CameraModel given =
      file.pinhole.value_or(pinhole_camera(640, 480, focal_for(480, glm::radians(kFovDeg))));
  const int width = given_width > 0 ? given_width : given.width;
  const int height = given_height > 0 ? given_height : given.height;
  return pinhole_camera(width, height, given.fy * height / given.height);
}

pipeline::Camera camera_for(const SceneFile& file, const PinholeView& view,
                            const CameraModel& model, const pipeline::Scene& scene) {
  if (file.world_from_camera) return view.camera(*file.world_from_camera, file.near_m, file.far_m);
  const Ball ball = ball_about(scene);
  const double tangent = 0.5 * std::min(model.width / model.fx, model.height / model.fy);
  const double distance = 1.05 * ball.radius * std::sqrt(1.0 + tangent * tangent) / tangent;
  // From the front, the right and above; OpenCV's axes.
  const glm::dvec3 z = -glm::normalize(glm::dvec3(0.45, 0.55, 1.0));
  const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0.0, 1.0, 0.0)));
  const glm::dvec3 eye = ball.middle - distance * z;
  const glm::dmat4 world_from_camera(glm::dvec4(x, 0.0), glm::dvec4(glm::cross(z, x), 0.0),
                                     glm::dvec4(z, 0.0), glm::dvec4(eye, 1.0));
  return view.camera(world_from_camera, 0.9 * (distance - ball.radius),
                     1.1 * (distance + ball.radius));
}

struct Buffers {
  raster::ColorBuffer color;
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;
  Buffers(const pipeline::Camera& camera, raster::ColorFormat format)
      : color(camera.width, camera.height, format),
        depth(camera.width, camera.height),
        stencil(camera.width, camera.height) {}
  raster::Targets targets() { return {&color, &depth, &stencil}; }
};

/// Runs the frame, stopping after every pass if its buffers are wanted.
void execute(const raster::Frame& frame, Buffers& buffers, const RenderOptions& options,
             Rendered& out) {
  std::size_t done = 0, end = 0;
  for (const raster::Pass& pass : frame.passes()) {
    end += pass.commands.size();
    out.passes.push_back({pass.label, pass.commands.size()});
    // A map's own pass draws elsewhere.
    if (!options.steps || pass.targets.color != &buffers.color) continue;
    raster::execute(frame, {.threads = options.threads, .first_command = done, .commands = end});
    done = end;
    out.steps.push_back({pass.label, buffer_picture(buffers.color), buffer_picture(buffers.depth),
                         buffer_picture(buffers.stencil)});
  }
  raster::execute(frame, {.threads = options.threads, .first_command = done});
}

class RayChecker {
 public:
  RayChecker(const pipeline::Camera& camera, const pipeline::GeneralOptions& method, int threads)
      : camera_(camera), method_(method), threads_(threads) {}

  /// Compares the light's picture with and without shadows with what rays say of its centre.
  RayCheck check(pipeline::Scene scene, pipeline::Light light, Image& wrong) {
    RayCheck result{.light = light.name};
    light.samples = 1;
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
      scene.objects[i].casts =
          pipeline::shadow_method(scene, light, scene.objects[i]) != pipeline::ShadowMethod::none;
    pipeline::Light unshadowed = light;
    unshadowed.shadow = pipeline::ShadowMethod::none;
    unshadowed.shadow_of_object.clear();
    pipeline::Light off = unshadowed;
    off.color = glm::vec3(0.0f);
    const raster::ColorBuffer shadowed = draw(scene, light), lit = draw(scene, unshadowed),
                              dark = draw(scene, off);
    const std::vector<pipeline::Ray> rays = pipeline::pixel_rays(camera_);
    const auto samples = pipeline::RayReference(pipeline::displace_casters(scene, light.position))
                             .cast(rays, light.position);
    std::vector<pipeline::RayReference::Sample> of_drawn;
    if (cast_as_drawn(scene.objects)) {
      of_drawn = pipeline::RayReference(scene).cast(rays, light.position);
      result.differ_from_drawn = 0;
    }
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        if (lit.at(x, y) == dark.at(x, y)) continue;
        const std::size_t i = static_cast<std::size_t>(y) * camera_.width + x;
        const auto& sample = samples[i];
        // Nothing falls on it, whatever is in the way.
        if (sample.hit.hit && !scene.objects[sample.hit.object].receives) continue;
        const bool is_dark = shadowed.at(x, y) != lit.at(x, y);
        const bool in_shadow = sample.shadow.in_shadow;
        ++result.tested;
        result.in_shadow += in_shadow;
        if (!of_drawn.empty()) *result.differ_from_drawn += is_dark != of_drawn[i].shadow.in_shadow;
        if (is_dark == in_shadow) continue;
        ++(is_dark ? result.too_dark : result.too_light);
        *(wrong.at(x, camera_.height - 1 - y) + (is_dark ? 0 : 2)) = 255;
      }
    }
    return result;
  }

 private:
  /// Takes the shadow models away. Was there a caster that had one?
  static bool cast_as_drawn(std::vector<pipeline::Object>& objects) {
    bool any = false;
    for (pipeline::Object& object : objects) {
      any = any || (object.casts && !object.casts_as_drawn());
      object.shadow_model = nullptr;
    }
    return any;
  }

  raster::ColorBuffer draw(pipeline::Scene& scene, const pipeline::Light& light) {
    scene.lights = {light};
    Buffers buffers(camera_, raster::ColorFormat::rgba32f);
    raster::execute(pipeline::record_general(scene, camera_, buffers.targets(), method_),
                    {.threads = threads_});
    return std::move(buffers.color);
  }

  const pipeline::Camera& camera_;
  const pipeline::GeneralOptions& method_;
  int threads_;
};

}  // namespace

namespace {

Rendered render(const SceneFile& file, const std::vector<ObjectModels>& models,
                const RenderOptions& options, RenderMemory& memory) {
  Rendered out;
  PlacedScene placed = place_scene(file, models, options.width, options.height);
  out.left_out = std::move(placed.left_out);
  const pipeline::Scene& scene = placed.scene;
  const pipeline::Camera& camera = placed.camera;
  out.objects = scene.objects.size();
  out.lights = scene.lights.size();
  for (const pipeline::Object& object : scene.objects)
    for (const pipeline::Part& part : object.model->parts)
      out.triangles += part.mesh.indices.size() / 3;

  // As in augment: the parts of several lights would each be rounded.
  Buffers buffers(camera, pipeline::sample_lights(scene).size() == 1
                              ? raster::ColorFormat::rgba8
                              : raster::ColorFormat::rgba32f);
  const pipeline::VolumeMethod counting =
      options.counting.value_or(volume_method(file.shadow.method));
  const pipeline::GeneralOptions additive{.method = counting,
                                          .extrusion = extrusion(file.shadow.volume),
                                          .topologies = &memory.topologies,
                                          .maps = &memory.maps,
                                          .threads = options.threads};
  Stopwatch watch;
  const raster::Frame frame =
      options.method == RenderMethod::additive
          ? pipeline::record_general(scene, camera, buffers.targets(), additive)
          : pipeline::record_modulative(scene, camera, buffers.targets(),
                                        {.method = counting,
                                         .extrusion = additive.extrusion,
                                         .topologies = &memory.topologies,
                                         .threads = options.threads});
  out.record_ms = watch.lap_ms();
  if (options.frame) out.frame = raster::encode_frame(frame);
  watch.lap_ms();
  execute(frame, buffers, options, out);
  out.execute_ms = watch.lap_ms();
  out.picture = buffer_picture(buffers.color);
  if (options.rays) {
    out.wrong = {camera.width, camera.height, 3,
                 std::vector<std::uint8_t>(out.picture.pixels.size(), 0)};
    RayChecker checker(camera, additive, options.threads);
    for (const pipeline::Light& light : scene.lights)
      out.checks.push_back(checker.check(scene, light, out.wrong));
  }
  return out;
}

}  // namespace

PlacedScene place_scene(const SceneFile& file, const std::vector<ObjectModels>& models, int width,
                        int height) {
  const SceneNodes nodes(file, models);
  PlacedScene out{.scene = nodes.scene(), .left_out = nodes.left_out()};
  if (out.scene.objects.empty())
    throw InputError(fmt::format("{}: every object hangs on a body, which only tags can place",
                                 one_line(file.file.string())));
  const CameraModel model = camera_model(file, width, height);
  out.camera = camera_for(file, PinholeView(Lens(model), 1), model, out.scene);
  return out;
}

Rendered render_scene(const SceneFile& file, const std::vector<ObjectModels>& models,
                      const RenderOptions& options, RenderMemory& memory) {
  try {
    return render(file, models, options, memory);
  } catch (const std::invalid_argument& misuse) {
    // What only the scene as a whole shows: nested scales, a lamp's planes.
    throw InputError(fmt::format("{}: {}", one_line(file.file.string()), misuse.what()));
  }
}

Rendered render_scene(const SceneFile& file, const RenderOptions& options) {
  RenderMemory memory;
  std::vector<std::string> notes;
  const std::vector<ObjectModels> models = load_models(file, &notes);
  Rendered out = render_scene(file, models, options, memory);
  out.notes = std::move(notes);
  return out;
}

}  // namespace gnomon::ar
