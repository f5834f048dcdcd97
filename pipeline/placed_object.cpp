#include "pipeline/placed_object.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

/// The mesh with a vertex of its own for every corner and the triangle's normal at all three.
std::shared_ptr<const Mesh> flat_shaded(const Mesh& mesh) {
  raster::require(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size(),
                  "colours are one a position");
  raster::require(mesh.texcoords.empty() || mesh.texcoords.size() == mesh.positions.size(),
                  "texture coordinates are one a position");
  auto flat = std::make_shared<Mesh>();
  const std::size_t corners = mesh.indices.size();
  flat->positions.reserve(corners);
  flat->normals.reserve(corners);
  for (std::size_t i = 0; i + 2 < corners; i += 3) {
    const std::uint32_t* index = &mesh.indices[i];
    const glm::vec3 a(mesh.positions[index[0]]), b(mesh.positions[index[1]]),
        c(mesh.positions[index[2]]);
    const glm::vec3 across = glm::cross(b - a, c - a);
    const float length = glm::length(across);
    const glm::vec3 normal = length > 0.0f ? across / length : glm::vec3(0.0f, 1.0f, 0.0f);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      flat->indices.push_back(static_cast<std::uint32_t>(flat->positions.size()));
      flat->positions.push_back(mesh.positions[index[corner]]);
      flat->normals.push_back(normal);
      if (!mesh.colors.empty()) flat->colors.push_back(mesh.colors[index[corner]]);
      if (!mesh.texcoords.empty()) flat->texcoords.push_back(mesh.texcoords[index[corner]]);
    }
  }
  return flat;
}

raster::FrontFace front_face_of(const glm::mat4& clip_from_model) {
  // OpenGL's projections mirror (z points into the screen), so an object that is not mirrored has a
  // negative determinant here.
  const double determinant = glm::determinant(glm::dmat4(clip_from_model));
  return determinant > 0.0 ? raster::FrontFace::cw : raster::FrontFace::ccw;
}

void draw_depth_of(raster::Frame& frame, std::span<const std::shared_ptr<const Mesh>> meshes,
                   const PlacedObject& object, const raster::State& state, int stencil_ref) {
  for (const std::shared_ptr<const Mesh>& mesh : meshes) {
    raster::Draw draw;
    draw.state = state;
    draw.state.front_face = object.front_face;
    draw.state.color = raster::ColorState::off();
    draw.mesh = {.positions = mesh->positions, .indices = mesh->indices};
    draw.clip_from_model = object.clip_from_model;
    draw.stencil_ref = stencil_ref;
    draw.label = object.object->name;
    frame.keep(mesh);
    frame.draw(std::move(draw));
  }
}

raster::Light raster_light(const Light& light) {
  return {.position = light.position,
          .diffuse = light.color,
          .specular = light.color,
          .attenuation = light.attenuation,
          .spot_direction = light.spot_direction,
          .spot_cos_cutoff = light.spot_cos_cutoff,
          .spot_exponent = light.spot_exponent};
}

}  // namespace

std::vector<PlacedObject> place_objects(const Scene& scene, const Camera& camera,
                                        TopologyCache& topologies) {
  std::vector<PlacedObject> placed;
  placed.reserve(scene.objects.size());
  for (const Object& object : scene.objects) {
    raster::require(object.model != nullptr, "an object has a model");
    PlacedObject item;
    item.object = &object;
    // Before the rest: it checks the indices that everything below relies on.
    item.topology = topologies.of(object.model);
    item.caster_topology = topologies.of(object.caster());
    for (const Part& part : object.model->parts) {
      const bool has_normals = part.mesh.normals.size() == part.mesh.positions.size();
      item.meshes.push_back(has_normals ? std::shared_ptr<const Mesh>(object.model, &part.mesh)
                                        : flat_shaded(part.mesh));
    }
    if (object.casts_as_drawn()) {
      item.caster_meshes = item.meshes;
    } else {
      for (const Part& part : object.shadow_model->parts)
        item.caster_meshes.emplace_back(object.shadow_model, &part.mesh);
    }
    const glm::mat3 linear(object.world_from_model);
    const float determinant = glm::determinant(linear);
    raster::require(std::isfinite(determinant) && determinant != 0.0f,
                    "an object's transform can be inverted");
    item.clip_from_model = camera.clip_from_world * object.world_from_model;
    item.world_from_model_normal = glm::transpose(glm::inverse(linear));
    item.front_face = front_face_of(item.clip_from_model);
    placed.push_back(std::move(item));
  }
  return placed;
}

raster::State surface_state() {
  raster::State state;
  state.depth_clamp = true;
  return state;
}

void draw_depth(raster::Frame& frame, const PlacedObject& object, const raster::State& state,
                int stencil_ref) {
  draw_depth_of(frame, object.meshes, object, state, stencil_ref);
}

void draw_caster_depth(raster::Frame& frame, const PlacedObject& object,
                       const raster::State& state) {
  draw_depth_of(frame, object.caster_meshes, object, state, 0);
}

void draw_lit(raster::Frame& frame, const PlacedObject& object, const Scene& scene,
              const Camera& camera, const LightTerms& terms, const raster::State& state,
              int stencil_ref) {
  const bool has_map = std::any_of(terms.shadow_maps.begin(), terms.shadow_maps.end(),
                                   [](const auto& map) { return map.has_value(); });
  for (std::size_t i = 0; i < object.meshes.size(); ++i) {
    const Part& part = object.object->model->parts[i];
    raster::Lit lit;
    lit.material = part.material;
    lit.material.alpha = 1.0f;
    for (const Light& light : terms.lights) lit.lights.push_back(raster_light(light));
    for (std::size_t l = 0; l < terms.shadow_maps.size(); ++l)
      lit.lights[l].shadow_map = terms.shadow_maps[l];
    lit.scene_ambient = scene.ambient;
    lit.ambient = terms.ambient;
    lit.emission = terms.emission;
    lit.diffuse = terms.diffuse;
    lit.specular = terms.specular;
    lit.two_sided = part.two_sided;
    lit.at_vertices = scene.vertex_lighting && !has_map;
    lit.eye_world = camera.eye_world;
    lit.world_from_model = object.object->world_from_model;
    lit.world_from_model_normal = object.world_from_model_normal;
    lit.texture = part.texture;

    raster::Draw draw;
    draw.state = state;
    draw.state.front_face = object.front_face;
    draw.mesh = object.meshes[i]->view();
    draw.clip_from_model = object.clip_from_model;
    draw.shading = std::move(lit);
    draw.stencil_ref = stencil_ref;
    draw.label = object.object->name;
    frame.keep(object.meshes[i]);
    frame.draw(std::move(draw));
  }
}

}  // namespace gnomon::pipeline
