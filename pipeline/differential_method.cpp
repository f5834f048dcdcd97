#include "pipeline/differential_method.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/casters.h"
#include "pipeline/near_clip.h"
#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

std::array<glm::dvec3, 8> corners_of(const Topology& topology, const Object& object) {
  const glm::dmat4 world(object.world_from_model);
  std::array<glm::dvec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::dvec3 p(i & 1 ? topology.high.x : topology.low.x,
                       i & 2 ? topology.high.y : topology.low.y,
                       i & 4 ? topology.high.z : topology.low.z);
    corners[i] = glm::dvec3(world * glm::dvec4(p, 1.0));
  }
  return corners;
}

/// Of its parts, each as much as it has triangles.
glm::dvec3 mean_reflectance(const Model& model) {
  glm::dvec3 sum(0.0);
  double triangles = 0.0;
  for (const Part& part : model.parts) {
    const auto count = static_cast<double>(part.mesh.triangle_count());
    sum += glm::dvec3(linear_color(part.material.diffuse)) * count;
    triangles += count;
  }
  return triangles > 0.0 ? sum / triangles : sum;
}

raster::State drawn_again() {
  raster::State state = surface_state();
  state.depth = raster::DepthState{.func = raster::CompareFunc::equal, .write = false};
  state.color.write = {true, true, true, false};
  state.color.blend = raster::Blend{.color_op = raster::BlendOp::reverse_subtract,
                                    .src_color = raster::BlendFactor::one,
                                    .dst_color = raster::BlendFactor::one};
  return state;
}

/// The part of the target that points can cover, with all triangles between them.
class Window {
 public:
  explicit Window(const Camera& camera) : camera_(camera), clip_(camera.clip_from_world) {}

  void add(const glm::dvec3& world) {
    const glm::dvec4 clip = clip_ * glm::dvec4(world, 1.0);
    if (!(clip.w > kLeastW)) {
      all_ = true;
      return;
    }
    low_ = glm::min(low_, glm::dvec2(clip) / clip.w);
    high_ = glm::max(high_, glm::dvec2(clip) / clip.w);
  }

  raster::Rect rect() const {
    if (all_) return {0, 0, camera_.width, camera_.height};
    const auto pixel = [](double ndc, int size, double pad) {
      return static_cast<int>(
          std::clamp((ndc + 1.0) * 0.5 * size + pad, 0.0, static_cast<double>(size)));
    };
    const int x0 = pixel(low_.x, camera_.width, -1.0), x1 = pixel(high_.x, camera_.width, 2.0);
    const int y0 = pixel(low_.y, camera_.height, -1.0), y1 = pixel(high_.y, camera_.height, 2.0);
    return {x0, y0, std::max(x1 - x0, 0), std::max(y1 - y0, 0)};
  }

 private:
  static constexpr double kLeastW = 1e-3;
  const Camera& camera_;
  glm::dmat4 clip_;
  glm::dvec2 low_{2.0}, high_{-2.0};
  bool all_ = false;
};

/// Where receivers can be in the shadow.
Window reach_of(const SourceShadow& shadow, const Camera& camera) {
  Window window(camera);
  for (const glm::dvec3& corner : shadow.reach) window.add(corner);
  return window;
}

std::string numbered(const char* label, std::size_t number) {
  return label + std::to_string(number);
}

}  // namespace

DifferentialMethod::DifferentialMethod(const LitScene& scene, const LightPaths& paths)
    : scene_(scene), paths_(paths), visibility_(scene.model), object_light_(scene, visibility_) {
  for (const PatchVertex& vertex : scene.model.vertices)
    model_positions_.emplace_back(vertex.position, 1.0f);
  for (const Patch& patch : scene.model.patches)
    if (!patch.distant)
      model_indices_.insert(model_indices_.end(), patch.vertices.begin(), patch.vertices.end());
}

raster::Frame DifferentialMethod::record(const Scene& virtual_scene, const Camera& camera,
                                         const raster::ImageView& photograph,
                                         const raster::Targets& targets,
                                         const DifferentialOptions& options) {
  raster::require(targets.color && targets.depth, "a differential shadow needs colour and depth");
  raster::require(options.mask == ShadowMask::map || targets.stencil,
                  "shadow volumes need a stencil buffer");
  const ShadowPrecision precision = options.take.precision;
  const bool bytes = precision == ShadowPrecision::bytes || precision == ShadowPrecision::dithered;
  raster::require(bytes == (targets.color->format() == raster::ColorFormat::rgba8),
                  "bytes go to RGBA8, values and radiance to RGBA32F");
  placed_ = place_objects(virtual_scene, camera, topologies_);
  std::vector<ShadowCaster> casters;
  std::vector<Bounds> boxes;
  for (const PlacedObject& object : placed_) {
    if (!object.object->casts || object.caster_topology->triangle_count() == 0) continue;
    // One that is moved away from a light hides nothing that it did not hide before.
    casters.push_back({corners_of(*object.caster_topology, *object.object),
                       mean_reflectance(*object.object->model)});
    Bounds& box = boxes.emplace_back();
    for (const glm::dvec3& p : casters.back().corners) box.add(p);
  }
  const auto start = std::chrono::steady_clock::now();
  occluded_.find(paths_, boxes);
  traverse_ms_ =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  find_shadows(scene_, paths_, occluded_, casters, object_light_.volume(), options.take, shadows_);
  const ObjectRadiance radiance =
      object_light_.radiance(placed_, camera.eye_world, options.take.threads);
  color_objects(radiance, options);
  if (options.self_shadows)
    take_from_objects(scene_, visibility_, placed_, radiance, shadows_.shadows, camera.eye_world,
                      options.take, taken_);
  else
    taken_.of_shadow.clear();

  raster::Frame frame;
  record_surfaces(frame, camera, photograph, targets, options);
  std::vector<std::optional<raster::DepthLookup>> maps(shadows_.shadows.size());
  for (std::size_t j = 0; j < maps.size() && options.mask == ShadowMask::map; ++j)
    maps[j] = record_map(frame, j, virtual_scene, options.map_size);
  for (std::size_t j = 0; j < maps.size(); ++j) {
    if (!maps[j]) count(frame, j, camera, targets, options);
    subtract(frame, j, camera, targets, maps[j]);
  }
  return frame;
}

void DifferentialMethod::record_surfaces(raster::Frame& frame, const Camera& camera,
                                         const raster::ImageView& photograph,
                                         const raster::Targets& targets,
                                         const DifferentialOptions& options) {
  const bool radiance = options.take.precision == ShadowPrecision::radiance;
  const bool white = options.take.by_share && !radiance;
  frame.begin_pass(white ? differential_label::kWhite : differential_label::kBackground, targets);
  raster::Clear clear{.color = white ? glm::vec4(1.0f, 1.0f, 1.0f, 0.0f) : glm::vec4(0.0f),
                      .depth = 1.0f};
  if (targets.stencil) clear.stencil = 0;
  frame.clear(clear);
  if (!white && !radiance) frame.blit({.image = photograph});
  frame.begin_pass(differential_label::kModel, targets);
  raster::State state = surface_state();
  state.depth = raster::DepthState{};
  state.color = raster::ColorState::off();
  frame.draw({.state = state,
              .mesh = {model_positions_, model_indices_},
              .clip_from_model = camera.clip_from_world,
              .label = "scene model"});
  frame.begin_pass(differential_label::kObjects, targets);
  state.color = {};
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    state.front_face = placed_[i].front_face;
    for (std::size_t p = 0; p < placed_[i].meshes.size(); ++p) {
      const auto& mesh = placed_[i].meshes[p];
      frame.keep(mesh);
      frame.draw({.state = state,
                  .mesh = {mesh->positions, mesh->indices, {}, drawn_[i][p], {}},
                  .clip_from_model = placed_[i].clip_from_model,
                  .label = placed_[i].object->name});
    }
  }
}

raster::DepthLookup DifferentialMethod::record_map(raster::Frame& frame, std::size_t number,
                                                   const Scene& virtual_scene, int size) {
  const SourceShadow& shadow = shadows_.shadows[number];
  const MapPlan plan{
      .light = shadow.light,
      .clip_from_world = shadow.view.clip_from_world(shadow.casters, shadow.near_m, shadow.far_m),
      .size = size};
  raster::DepthLookup lookup = record_shadow_map(
      frame, placed_, Casters(virtual_scene), "source " + std::to_string(number), plan,
      raster::Filter::nearest, maps_.map(number, size, raster::DepthFormat::d24));
  // One where something lies before the point, 0 where the light comes through.
  lookup.func = raster::CompareFunc::greater;
  return lookup;
}

void DifferentialMethod::count(raster::Frame& frame, std::size_t number, const Camera& camera,
                               const raster::Targets& targets, const DifferentialOptions& options) {
  const SourceShadow& shadow = shadows_.shadows[number];
  frame.begin_pass(numbered(differential_label::kVolumes, number), targets);
  Window seen = reach_of(shadow, camera);
  std::size_t mesh = 0;
  for (std::size_t i = 0; i < placed_.size() && options.self_shadows; ++i) {
    bool takes = false;
    for (std::size_t p = 0; p < placed_[i].meshes.size(); ++p, ++mesh)
      takes = takes || taken_.of_shadow[number][mesh].any;
    if (!takes) continue;
    for (const glm::dvec3& corner : corners_of(*placed_[i].topology, *placed_[i].object))
      seen.add(corner);
  }
  const raster::Rect window = seen.rect();
  if (window.width == 0 || window.height == 0) return;
  frame.clear({.stencil = 0, .scissor = window});
  const Light light{.position = shadow.light};
  std::vector<PlacedVolume> volumes =
      make_volumes(placed_, light, {}, near_region(camera.clip_from_world),
                   {.extrusion = {.kind = Extrusion::Kind::infinite},
                    .threads = options.take.threads,
                    .memory = &volumes_});
  for (PlacedVolume& volume : volumes) volume.window = window;
  count_volumes(frame, volumes, {.in_batches = true, .casters_drawn = true});
}

void DifferentialMethod::subtract(raster::Frame& frame, std::size_t number, const Camera& camera,
                                  const raster::Targets& targets,
                                  const std::optional<raster::DepthLookup>& map) {
  const SourceShadow& shadow = shadows_.shadows[number];
  frame.begin_pass(numbered(differential_label::kSubtract, number), targets);
  raster::State state = drawn_again();
  if (!map) state.stencil = raster::StencilState::both({.func = raster::CompareFunc::not_equal});
  if (!shadow.indices.empty()) {
    raster::State cut = state;
    cut.scissor = reach_of(shadow, camera).rect();
    frame.draw({.state = cut,
                .mesh = {shadows_.positions, shadow.indices, {}, shadow.colors, {}},
                .clip_from_model = camera.clip_from_world,
                .shading = raster::Flat{.depth_lookup = map},
                .label = "receivers"});
  }
  if (taken_.of_shadow.empty()) return;
  std::size_t number_of_mesh = 0;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    std::optional<raster::DepthLookup> lookup = map;
    if (lookup) lookup->map_from_position *= placed_[i].object->world_from_model;
    state.front_face = placed_[i].front_face;
    for (const auto& mesh : placed_[i].meshes) {
      const std::vector<std::uint32_t>& indices = taken_.indices[number_of_mesh];
      const MeshTake& take = taken_.of_shadow[number][number_of_mesh++];
      if (!take.any) continue;
      frame.draw({.state = state,
                  .mesh = {mesh->positions, indices, {}, take.colors, {}},
                  .clip_from_model = placed_[i].clip_from_model,
                  .shading = raster::Flat{.depth_lookup = lookup},
                  .label = placed_[i].object->name});
    }
  }
}

void DifferentialMethod::color_objects(const ObjectRadiance& radiance,
                                       const DifferentialOptions& options) {
  drawn_.resize(placed_.size());
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    auto value = radiance[i].begin();
    drawn_[i].resize(placed_[i].meshes.size());
    for (std::size_t p = 0; p < placed_[i].meshes.size(); ++p) {
      const std::size_t count = placed_[i].meshes[p]->positions.size();
      drawn_[i][p].resize(count);
      for (glm::vec4& color : drawn_[i][p]) {
        const glm::vec3 light = *value++;
        color = options.take.precision == ShadowPrecision::radiance
                    ? glm::vec4(light, 1.0f)
                    : glm::vec4(glm::vec3(scene_.tone.value(glm::dvec3(light)) / 255.0), 1.0f);
      }
    }
  }
}

}  // namespace gnomon::pipeline
