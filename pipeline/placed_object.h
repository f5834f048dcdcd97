// Objects of a scene as one frame sees them, and the draws of their surfaces.
// Invariant: clip_from_model = clip_from_world * world_from_model is computed here, once an object
// and frame, and serves the object's surface and its shadow volumes alike; all are drawn with depth
// clamp, so that no near or far plane cuts one and not the other. Hence a front cap has the depth
// bits of the surface that it lies on, and depth EQUAL finds the visible fragments again. Of an
// object that casts as drawn (Object::casts_as_drawn), that surface is in the depth buffer.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "pipeline/scene.h"
#include "pipeline/topology.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

struct PlacedObject {
  const Object* object = nullptr;
  /// Of what is drawn, and of what casts: the same one if the object casts as drawn.
  std::shared_ptr<const Topology> topology, caster_topology;
  /// One a part, with normals: the model's own mesh or, where that has none, a flat-shaded copy of
  /// the same positions.
  std::vector<std::shared_ptr<const Mesh>> meshes;
  /// What casts, for draws without colour; `meshes` if the object casts as drawn.
  std::vector<std::shared_ptr<const Mesh>> caster_meshes;
  glm::mat4 clip_from_model{1.0f};
  glm::mat3 world_from_model_normal{1.0f};
  /// Counter-clockwise from outside in the model, or (a mirroring transform) clockwise?
  raster::FrontFace front_face = raster::FrontFace::ccw;

  bool is(Role role) const { return object->role == role; }
};

/// The scene's objects in order. They point into `scene`, which must outlive them.
/// Precondition: every object has a model and a transform that can be inverted.
std::vector<PlacedObject> place_objects(const Scene& scene, const Camera& camera,
                                        TopologyCache& topologies);

/// State that every draw of a shadow method starts from: depth clamp on, everything else off, no
/// culling (an open mesh is visible from both sides).
raster::State surface_state();

/// Which terms of the lighting equation a pass draws, of which lights.
struct LightTerms {
  bool ambient = false, emission = false, diffuse = false, specular = false;
  std::span<const Light> lights = {};
  /// One a light, or none at all: scales its diffuse and specular terms.
  std::span<const std::optional<raster::DepthLookup>> shadow_maps = {};
};

/// Records the parts of what is drawn without colour.
void draw_depth(raster::Frame& frame, const PlacedObject& object, const raster::State& state,
                int stencil_ref = 0);

/// The same of what casts.
void draw_caster_depth(raster::Frame& frame, const PlacedObject& object,
                       const raster::State& state);

/// Records the object's parts with lighting; the material's alpha counts as 1. With
/// Scene::vertex_lighting they are lit at vertices, unless one of the shadow maps is there: those
/// terms are lit pixel by pixel. The frame keeps the meshes.
void draw_lit(raster::Frame& frame, const PlacedObject& object, const Scene& scene,
              const Camera& camera, const LightTerms& terms, const raster::State& state,
              int stencil_ref = 0);

}  // namespace gnomon::pipeline
