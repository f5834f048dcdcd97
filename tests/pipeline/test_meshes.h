// Meshes, transforms and cameras that the tests of pipeline/ build for themselves.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene.h"

namespace gnomon::test {

/// A box of that half size about the origin: 8 vertices, 12 triangles.
pipeline::Mesh box_mesh(const glm::vec3& half);

/// The same with three vertices of its own a triangle and normals.
pipeline::Mesh flat_box_mesh(const glm::vec3& half);

/// A torus about y; 2 * around * across triangles, smooth normals.
pipeline::Mesh torus_mesh(float major, float minor, int around, int across);

/// An icosahedron, each triangle cut in four `levels` times, on the sphere of that radius.
pipeline::Mesh icosphere_mesh(float radius, int levels);

/// A square of that half size in the plane y = 0, facing up: two triangles, an open mesh.
pipeline::Mesh square_mesh(float half);

std::shared_ptr<const pipeline::Model> model_of(pipeline::Mesh mesh);

/// Rotation by `angle` (radians) about an axis, then a move.
glm::mat4 placed(const glm::vec3& at, const glm::vec3& axis = {0.0f, 1.0f, 0.0f}, float angle = 0,
                 const glm::vec3& scale = glm::vec3(1.0f));

/// OpenGL's perspective camera.
pipeline::Camera look(const glm::vec3& eye, const glm::vec3& at, int width, int height,
                      float fov_y_deg = 50.0f, float near = 0.05f, float far = 60.0f);

/// Uniform in [low, high], the same on every machine.
float uniform(std::mt19937& random, float low, float high);
/// Uniform in [0, count).
unsigned below(std::mt19937& random, std::size_t count);
glm::vec3 uniform_point(std::mt19937& random, float low, float high);

/// Random corners and triangles: edges of any number of triangles, in any direction.
pipeline::Mesh soup(std::mt19937& random);

/// A ground plate and 2 to 5 closed bodies (boxes, tori, spheres; turned, scaled, some mirrored)
/// above it, by turns phantoms and virtual; one light above, a point or a direction.
pipeline::Scene random_scene(std::mt19937& random);

}  // namespace gnomon::test
