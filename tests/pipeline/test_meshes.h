// Random meshes and scenes that the tests of pipeline/ build for themselves, beside the shapes of
// pipeline/shapes.h.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene.h"
#include "pipeline/shapes.h"

namespace gnomon::test {

using pipeline::box_mesh;
using pipeline::flat_box_mesh;
using pipeline::icosphere_mesh;
using pipeline::look;
using pipeline::model_of;
using pipeline::placed;
using pipeline::square_mesh;
using pipeline::torus_mesh;

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
