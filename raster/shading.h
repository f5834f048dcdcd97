// How a fragment gets its colour: a constant, or OpenGL's lighting equation (4.6 compatibility,
// section 12.2) per fragment or per vertex, in world space, with the half vector of a local viewer.
// Sums and products only, each rounded once in the order written in shading.cpp; powers by repeated
// squaring, so no library function lies on the way to a pixel.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "raster/depth_lookup.h"
#include "raster/texture.h"

namespace gnomon::raster {

/// Which channels a depth lookup scales (GL_DEPTH_TEXTURE_MODE): r, g, b; alpha; or all four.
enum class DepthTextureMode : std::uint8_t { luminance, alpha, intensity };

/// color, times the mesh's colours if it has some, times the texture and the depth lookup if there
/// are some.
struct Flat {
  glm::vec4 color{1.0f};
  std::shared_ptr<const Texture> texture = nullptr;
  std::optional<DepthLookup> depth_lookup = std::nullopt;
  DepthTextureMode depth_texture_mode = DepthTextureMode::luminance;
};

struct Material {
  glm::vec3 ambient{0.2f}, diffuse{0.8f}, specular{0.0f}, emission{0.0f};
  /// Exponent of the specular term.
  int shininess = 0;
  float alpha = 1.0f;
};

struct Light {
  /// World space. w = 1: a point; w = 0: the direction towards a light at infinity.
  glm::vec4 position{0.0f, 0.0f, 1.0f, 0.0f};
  glm::vec3 ambient{0.0f}, diffuse{1.0f}, specular{1.0f};
  /// Constant, linear and quadratic attenuation; of a point only.
  glm::vec3 attenuation{1.0f, 0.0f, 0.0f};
  /// Unit vector along the beam. Fragments whose cosine to it is below spot_cos_cutoff get nothing;
  /// -1 is no spot.
  glm::vec3 spot_direction{0.0f, -1.0f, 0.0f};
  float spot_cos_cutoff = -1.0f;
  int spot_exponent = 0;
  /// A shadow map: its lookup scales the light's diffuse and specular terms.
  std::optional<DepthLookup> shadow_map = std::nullopt;
};

/// Lighting of a mesh that has normals. Terms can be left out, so that a pass draws ambient and
/// emission only, or one light's diffuse and specular only. Texture and vertex colours scale
/// ambient and diffuse, and alpha, which is the material's.
struct Lit {
  Material material;
  std::vector<Light> lights;
  glm::vec3 scene_ambient{0.0f};
  bool ambient = true, emission = true, diffuse = true, specular = true;
  /// Back faces are lit with the reversed normal.
  bool two_sided = false;
  /// The fixed function's own lighting (OpenGL 4.6 compatibility, section 12.2): the equation at
  /// each vertex of the mesh, its normal normalised (GL_NORMALIZE), its colours and alpha clamped
  /// to [0, 1] (not a number: 0); they are interpolated to fragments as a mesh's colours are, and
  /// not clamped again. The specular term is part of the sum (GL_SINGLE_COLOR), so the texture
  /// scales it too. With two_sided a vertex has a colour a side, and a triangle's facing chooses,
  /// of a piece that clipping made its own. Misuse: a light with a shadow map, which only fragments
  /// can look up.
  bool at_vertices = false;
  glm::vec3 eye_world{0.0f};
  glm::mat4 world_from_model{1.0f};
  /// Inverse transpose of the upper 3x3 of world_from_model, up to a positive scale.
  glm::mat3 world_from_model_normal{1.0f};
  std::shared_ptr<const Texture> texture;
};

using Shading = std::variant<Flat, Lit>;

/// What is interpolated, perspective-correct, to a fragment; or a vertex's own.
struct Fragment {
  glm::vec3 world{0.0f}, normal{0.0f};
  /// Position in the mesh's own space.
  glm::vec4 model{0.0f, 0.0f, 0.0f, 1.0f};
  /// The mesh's colour; of a fragment that is lit at vertices, what light_vertex() gave them.
  glm::vec4 color{1.0f};
  glm::vec2 texcoord{0.0f};
  bool front_facing = true;
};

/// The colour of a fragment, not clamped.
glm::vec4 shade(const Shading& shading, const Fragment& fragment);

/// What Lit::at_vertices gives a vertex, without the texture: in [0, 1].
glm::vec4 light_vertex(const Lit& lit, const Fragment& vertex);

}  // namespace gnomon::raster
