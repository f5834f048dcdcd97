// Scenes that look up depth buffers: a pass of depth alone from a lamp, then the picture.
// Every number on the way to a vertex is made by + - * / from the ones written here.
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "golden/box.h"
#include "golden/scenes.h"

namespace gnomon::golden {
namespace {

using raster::ColorFormat;
using raster::CompareFunc;
using raster::DepthFormat;
using raster::Filter;

struct Turn {
  float sine, cosine;
};

/// Sees along -z after a turn to the right about y and then down.
struct Eye {
  glm::vec3 at;
  Turn right, down;
  glm::vec2 focal;

  glm::mat4 clip_from_world() const {
    constexpr float kNear = 0.5f, kFar = 12.0f;
    const glm::vec3 x{right.cosine, 0.0f, -right.sine};
    const glm::vec3 y{-down.sine * right.sine, down.cosine, -down.sine * right.cosine};
    const glm::vec3 z{right.sine * down.cosine, down.sine, right.cosine * down.cosine};
    const auto along = [&](const glm::vec3& axis) {
      return -(axis.x * at.x + axis.y * at.y + axis.z * at.z);
    };
    const glm::mat4 eye_from_world{{x.x, y.x, z.x, 0.0f},
                                   {x.y, y.y, z.y, 0.0f},
                                   {x.z, y.z, z.z, 0.0f},
                                   {along(x), along(y), along(z), 1.0f}};
    const glm::mat4 clip_from_eye{{focal.x, 0.0f, 0.0f, 0.0f},
                                  {0.0f, focal.y, 0.0f, 0.0f},
                                  {0.0f, 0.0f, -(kFar + kNear) / (kFar - kNear), -1.0f},
                                  {0.0f, 0.0f, -2.0f * kFar * kNear / (kFar - kNear), 0.0f}};
    return clip_from_eye * eye_from_world;
  }
};

const Eye kViewer{{-1.12f, 3.0f, 3.84f}, {-0.28f, 0.96f}, {0.6f, 0.8f}, {1.5f, 2.0f}};
const Eye kLamp{{1.62f, 3.6f, 2.16f}, {0.6f, 0.8f}, {0.8f, 0.6f}, {1.8f, 1.8f}};
const Eye kOtherLamp{{-2.7f, 3.6f, 0.0f}, {-1.0f, 0.0f}, {0.8f, 0.6f}, {1.2f, 1.5f}};

/// From a position in the world to (s, t, r, q) of the lamp's map.
glm::mat4 map_from_world(const Eye& lamp) {
  const glm::mat4 map_from_clip{{0.5f, 0.0f, 0.0f, 0.0f},
                                {0.0f, 0.5f, 0.0f, 0.0f},
                                {0.0f, 0.0f, 0.5f, 0.0f},
                                {0.5f, 0.5f, 0.5f, 1.0f}};
  return map_from_clip * lamp.clip_from_world();
}

struct Block {
  pipeline::Mesh mesh;
  glm::vec3 at, color;
};

/// A plate and two blocks, one of them in the air.
std::vector<Block> blocks() {
  return {{box({1.8f, 0.1f, 1.8f}), {0.0f, -0.1f, 0.0f}, {0.8f, 0.8f, 0.7f}},
          {box({0.3f, 0.5f, 0.3f}), {-0.5f, 0.5f, 0.3f}, {0.8f, 0.3f, 0.2f}},
          {box({0.6f, 0.1f, 0.2f}), {0.5f, 1.0f, -0.2f}, {0.3f, 0.4f, 0.9f}}};
}

glm::mat4 moved(const glm::vec3& by) {
  return {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {by, 1.0f}};
}

raster::Draw draw_of(const Block& block, const glm::mat4& clip_from_world) {
  return {.state = {.depth = raster::DepthState{.func = CompareFunc::less_equal},
                    .cull = raster::Cull::back},
          .mesh = {block.mesh.positions, block.mesh.indices, block.mesh.normals},
          .clip_from_model = clip_from_world * moved(block.at)};
}

raster::DepthBuffer& add_map(raster::RecordedFrame& out, Size size, DepthFormat format) {
  return std::get<raster::DepthBuffer>(out.buffers.emplace_back(
      std::in_place_type<raster::DepthBuffer>, size.width, size.height, format));
}

/// Depth alone, pushed away by the offset that keeps surfaces out of their own shadow.
void record_map(raster::Frame& frame, raster::DepthBuffer& map, const Eye& lamp,
                std::span<const Block> casters) {
  frame.begin_pass("shadow map: depth from the lamp", {.depth = &map});
  frame.clear({.depth = 1.0f});
  for (const Block& block : casters) {
    raster::Draw draw = draw_of(block, lamp.clip_from_world());
    draw.state.polygon_offset = raster::PolygonOffset{2.0f, 4.0f};
    frame.draw(draw);
  }
}

raster::Light light_of(const Eye& lamp, const glm::vec3& color, const raster::DepthLookup& map) {
  raster::Light light;
  light.position = {lamp.at, 1.0f};
  light.diffuse = color;
  light.specular = 0.5f * color;
  light.shadow_map = map;
  return light;
}

void record_lit(raster::Frame& frame, const raster::Targets& targets, std::span<const Block> seen,
                const std::vector<raster::Light>& lights) {
  frame.begin_pass("lit through the shadow maps", targets);
  frame.clear({.color = glm::vec4(0.1f, 0.1f, 0.2f, 0.0f), .depth = 1.0f, .stencil = 0});
  for (const Block& block : seen) {
    raster::Lit lit;
    lit.material = {.ambient = block.color,
                    .diffuse = block.color,
                    .specular = glm::vec3(0.4f),
                    .shininess = 12};
    lit.scene_ambient = glm::vec3(0.2f);
    lit.lights = lights;
    lit.eye_world = kViewer.at;
    lit.world_from_model = moved(block.at);
    raster::Draw draw = draw_of(block, kViewer.clip_from_world());
    draw.shading = lit;
    frame.draw(draw);
  }
}

raster::RecordedFrame record_nearest() {
  raster::RecordedFrame out;
  raster::DepthBuffer& map = add_map(out, {64, 64}, DepthFormat::d24);
  const raster::Targets targets = add_targets(out, {160, 120}, {});
  const auto kept = std::make_shared<const std::vector<Block>>(blocks());
  out.frame.keep(kept);
  record_map(out.frame, map, kLamp, *kept);
  record_lit(out.frame, targets, *kept,
             {light_of(kLamp, glm::vec3(0.8f),
                       {.map = &map, .map_from_position = map_from_world(kLamp)})});
  return out;
}

/// Two lamps, percentage-closer filtering, one map that goes on beyond its edge and one that is
/// shadow there.
raster::RecordedFrame record_linear() {
  raster::RecordedFrame out;
  raster::DepthBuffer& map = add_map(out, {48, 40}, DepthFormat::d16);
  raster::DepthBuffer& other = add_map(out, {33, 70}, DepthFormat::d24);
  const raster::Targets targets = add_targets(out, {130, 97}, {.color = ColorFormat::rgba32f});
  const auto kept = std::make_shared<const std::vector<Block>>(blocks());
  out.frame.keep(kept);
  record_map(out.frame, map, kLamp, *kept);
  record_map(out.frame, other, kOtherLamp, *kept);
  record_lit(out.frame, targets, *kept,
             {light_of(kLamp, {0.7f, 0.6f, 0.5f},
                       {.map = &map,
                        .map_from_position = map_from_world(kLamp),
                        .filter = Filter::linear,
                        .border = std::nullopt}),
              light_of(kOtherLamp, {0.2f, 0.3f, 0.5f},
                       {.map = &other,
                        .map_from_position = map_from_world(kOtherLamp),
                        .func = CompareFunc::less,
                        .filter = Filter::linear,
                        .border = 0.0f})});
  return out;
}

/// Flat draws scaled in colour, in alpha (blended) and in both; then the map is drawn anew without
/// a block and looked up once more: a lookup sees what the frame has drawn before it.
raster::RecordedFrame record_modes() {
  using Mode = raster::DepthTextureMode;
  raster::RecordedFrame out;
  raster::DepthBuffer& map = add_map(out, {70, 50}, DepthFormat::d24);
  const raster::Targets targets = add_targets(out, {160, 120}, {});
  const auto kept = std::make_shared<const std::vector<Block>>(blocks());
  out.frame.keep(kept);
  const auto draw_plate = [&](const glm::vec4& color, Mode mode, CompareFunc func, Filter filter,
                              std::optional<raster::Rect> scissor) {
    raster::Draw draw = draw_of((*kept)[0], kViewer.clip_from_world());
    draw.state.color.blend = raster::Blend{.src_color = raster::BlendFactor::src_alpha,
                                           .dst_color = raster::BlendFactor::one_minus_src_alpha,
                                           .dst_alpha = raster::BlendFactor::one_minus_src_alpha};
    draw.state.scissor = scissor;
    // A flat colour's matrix begins at the mesh's own space.
    draw.shading = raster::Flat{
        .color = color,
        .depth_lookup =
            raster::DepthLookup{.map = &map,
                                .map_from_position = map_from_world(kLamp) * moved((*kept)[0].at),
                                .func = func,
                                .filter = filter},
        .depth_texture_mode = mode};
    out.frame.draw(draw);
  };
  record_map(out.frame, map, kLamp, *kept);
  out.frame.begin_pass("flat through the shadow map", targets);
  out.frame.clear({.color = glm::vec4(0.3f, 0.2f, 0.1f, 1.0f), .depth = 1.0f, .stencil = 0});
  draw_plate({0.9f, 0.8f, 0.7f, 1.0f}, Mode::luminance, CompareFunc::less_equal, Filter::linear,
             std::nullopt);
  draw_plate({0.1f, 0.2f, 0.9f, 0.6f}, Mode::alpha, CompareFunc::greater, Filter::nearest,
             raster::Rect{0, 0, 90, 120});
  draw_plate({0.2f, 0.9f, 0.3f, 0.7f}, Mode::intensity, CompareFunc::greater_equal, Filter::linear,
             raster::Rect{60, 30, 70, 60});
  record_map(out.frame, map, kLamp, std::span(*kept).first(2));
  out.frame.begin_pass("flat through the map drawn anew", targets);
  draw_plate({0.9f, 0.2f, 0.2f, 0.5f}, Mode::alpha, CompareFunc::greater, Filter::linear,
             std::nullopt);
  return out;
}

}  // namespace

void add_shadow_map_scenes(std::vector<Scene>& all) {
  all.push_back({.name = "shadow-map-nearest", .record = record_nearest, .quick = true});
  all.push_back({.name = "shadow-map-linear", .record = record_linear, .quick = true});
  all.push_back({.name = "shadow-map-modes", .record = record_modes, .quick = true});
}

}  // namespace gnomon::golden
