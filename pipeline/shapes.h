// Meshes, transforms and cameras for whoever builds a scene without files: examples, studies,
// tests. Units are metres; Y is up.
#pragma once

#include <memory>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/mesh.h"
#include "pipeline/scene.h"

namespace gnomon::pipeline {

/// A box of that half size about the origin: 8 vertices, 12 triangles.
Mesh box_mesh(const glm::vec3& half);

/// The same with three vertices of its own a triangle and normals.
Mesh flat_box_mesh(const glm::vec3& half);

/// A torus about y; 2 * around * across triangles, smooth normals.
Mesh torus_mesh(float major, float minor, int around, int across);

/// An icosahedron, each triangle cut in four `levels` times, on the sphere of that radius.
Mesh icosphere_mesh(float radius, int levels);

/// A square of that half size in the plane y = 0, facing up: two triangles, an open mesh.
Mesh square_mesh(float half);

std::shared_ptr<const Model> model_of(Mesh mesh);

/// Rotation by `angle` (radians) about an axis, then a move.
glm::mat4 placed(const glm::vec3& at, const glm::vec3& axis = {0.0f, 1.0f, 0.0f}, float angle = 0,
                 const glm::vec3& scale = glm::vec3(1.0f));

/// OpenGL's perspective camera.
Camera look(const glm::vec3& eye, const glm::vec3& at, int width, int height,
            float fov_y_deg = 50.0f, float near = 0.05f, float far = 60.0f);

}  // namespace gnomon::pipeline
