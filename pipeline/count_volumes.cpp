#include "pipeline/count_volumes.h"

namespace gnomon::pipeline {
namespace {

std::vector<WorldTriangle> casting_triangles(const PlacedObject& object,
                                             const Silhouette& silhouette) {
  const Topology& topology = *object.topology;
  const glm::dmat4 world(object.object->world_from_model);
  std::vector<WorldTriangle> triangles;
  for (std::size_t t = 0; t < silhouette.casting.size(); ++t) {
    if (silhouette.casting[t] == 0) continue;
    WorldTriangle triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      triangle[corner] =
          glm::dvec3(world * glm::dvec4(topology.positions[topology.indices[3 * t + corner]]));
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

ShadowVolume extrude(const PlacedObject& object, const Light& light, const Receivers& receivers,
                     const Extrusion& extrusion, std::optional<Reach>& reach) {
  const glm::mat4& world_from_model = object.object->world_from_model;
  const glm::dvec4 light_model = light_in_model(light.position, world_from_model);
  const Silhouette silhouette = find_silhouette(*object.topology, light_model);
  switch (extrusion.kind) {
    case Extrusion::Kind::radius:
      return extrude_by_radius(*object.topology, silhouette, light_model, world_from_model,
                               static_cast<double>(extrusion.radius_m));
    case Extrusion::Kind::infinite:
      return extrude_to_infinity(*object.topology, silhouette, light_model);
    case Extrusion::Kind::automatic:
      break;
  }
  reach = find_reach(light.position, casting_triangles(object, silhouette), receivers);
  if (reach->kind == Reach::Kind::none) return {};
  if (reach->kind == Reach::Kind::unbounded) {
    return extrude_to_infinity(*object.topology, silhouette, light_model);
  }
  return extrude_by(*object.topology, silhouette, light_model, reach->amount);
}

raster::StencilFace face(const CountOptions& options, VolumeMethod method, raster::StencilOp op) {
  raster::StencilFace result;
  result.write_mask = options.write_mask;
  (method == VolumeMethod::zpass ? result.pass : result.depth_fail) = op;
  return result;
}

raster::Draw counting_draw(const PlacedVolume& volume, const CountOptions& options) {
  raster::Draw draw;
  draw.state = surface_state();
  draw.state.depth = raster::DepthState{.func = raster::CompareFunc::less, .write = false};
  draw.state.color = raster::ColorState::off();
  draw.state.front_face = volume.front_face;
  draw.mesh = volume.volume->view();
  draw.clip_from_model = volume.clip_from_model;
  draw.label = "volume of " + volume.caster->name;
  if (!options.light_name.empty()) draw.label += " from " + options.light_name;
  draw.label += volume.method == VolumeMethod::zpass ? " (z-pass)" : " (z-fail)";
  return draw;
}

void count_two_sided(raster::Frame& frame, const PlacedVolume& volume,
                     const CountOptions& options) {
  raster::Draw draw = counting_draw(volume, options);
  const bool zpass = volume.method == VolumeMethod::zpass;
  using raster::StencilOp;
  draw.state.stencil = raster::StencilState{
      face(options, volume.method, zpass ? StencilOp::incr_wrap : StencilOp::decr_wrap),
      face(options, volume.method, zpass ? StencilOp::decr_wrap : StencilOp::incr_wrap)};
  frame.draw(std::move(draw));
}

/// One of the appendix's two draws: the faces that add, or those that take away.
void count_single_sided(raster::Frame& frame, const PlacedVolume& volume,
                        const CountOptions& options, bool add) {
  raster::Draw draw = counting_draw(volume, options);
  const bool front = (volume.method == VolumeMethod::zpass) == add;
  draw.state.cull = front ? raster::Cull::back : raster::Cull::front;
  draw.state.stencil = raster::StencilState::both(
      face(options, volume.method, add ? raster::StencilOp::incr : raster::StencilOp::decr));
  draw.label += front ? ", front faces" : ", back faces";
  frame.draw(std::move(draw));
}

}  // namespace

std::vector<PlacedVolume> make_volumes(std::span<const PlacedObject> objects, const Light& light,
                                       const Receivers& receivers,
                                       const std::optional<NearRegion>& region,
                                       const VolumeOptions& options) {
  std::vector<PlacedVolume> volumes;
  for (const PlacedObject& object : objects) {
    if (!object.object->casts) continue;
    PlacedVolume placed;
    auto volume = std::make_shared<ShadowVolume>(
        extrude(object, light, receivers, options.extrusion, placed.reach));
    if (volume->empty()) continue;
    placed.volume = std::move(volume);
    placed.caster = object.object;
    placed.clip_from_model = object.clip_from_model;
    placed.front_face = object.front_face;
    placed.method = choose_method(options.method, region, light.position, *object.topology,
                                  object.object->world_from_model);
    volumes.push_back(std::move(placed));
  }
  return volumes;
}

void count_volumes(raster::Frame& frame, std::span<const PlacedVolume> volumes,
                   const CountOptions& options) {
  for (const PlacedVolume& volume : volumes) frame.keep(volume.volume);
  if (!options.appendix_letter) {
    for (const PlacedVolume& volume : volumes) count_two_sided(frame, volume, options);
    return;
  }
  for (const bool add : {true, false}) {
    for (const PlacedVolume& volume : volumes) count_single_sided(frame, volume, options, add);
  }
}

}  // namespace gnomon::pipeline
