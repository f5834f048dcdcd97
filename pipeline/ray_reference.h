// An independent answer to what the stencil methods answer: is the light hidden from the visible
// point? Rays through a scene by Embree in robust mode. Knows nothing of volumes, silhouettes or
// buffers, and of no camera: it takes rays, so it serves a lens of any shape.
// What counts as shadow: a caster's triangle, from either side, lies between the point and the
// light; or the side of a caster's surface that is seen is turned away from the light, so that the
// surface itself is in between. What casts is Object::caster(): of an object in whose place another
// mesh casts, the surface that is seen hides nothing, and a point of it is in shadow if that mesh
// is in between. Where the two coincide, the point lies on the side that is seen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/scene.h"

namespace gnomon::pipeline {

/// Which objects take part; as casters, only those that cast.
enum class Among : std::uint8_t { all, virtual_objects, phantoms };

struct Ray {
  glm::dvec3 origin{0.0}, direction{0.0, 0.0, -1.0};
};

struct RayHit {
  bool hit = false;
  /// Index in Scene::objects, and of the triangle among those of all its model's parts in turn.
  std::size_t object = 0, triangle = 0;
  /// Distance along the ray in units of its direction's length.
  double distance = 0.0;
  glm::dvec3 point{0.0};
  /// Unit normal of the triangle, on the side that is seen.
  glm::dvec3 normal{0.0};
};

/// Is the light hidden?
struct RayShadow {
  bool in_shadow = false;
  /// The side that is seen is turned away from the light (n.l <= 0).
  bool faces_away = false;
  /// Something stands between the light and the surface's side that faces it (the side that is
  /// seen, of a surface that does not cast itself because another mesh does).
  bool blocked = false;
};

class RayReference {
 public:
  /// Copies the scene's triangles into world space. Throws std::runtime_error when Embree cannot
  /// start.
  explicit RayReference(const Scene& scene);
  ~RayReference();
  RayReference(const RayReference&) = delete;
  RayReference& operator=(const RayReference&) = delete;

  /// The nearest surface, from either side.
  RayHit trace(const Ray& ray, Among visible = Among::all) const;

  /// Shadow of a light (taken as a point or direction: position only) at a hit.
  RayShadow shadow(const RayHit& hit, const glm::vec4& light, Among casters = Among::all) const;

  /// Does a caster stand between the point and the light? No care about surfaces at the point.
  bool blocked(const glm::dvec3& point, const glm::vec4& light, Among casters = Among::all) const;

  struct Sample {
    RayHit hit;
    RayShadow shadow;
  };
  /// Trace and shadow for each ray; no shadow where nothing is hit.
  std::vector<Sample> cast(std::span<const Ray> rays, const glm::vec4& light,
                           Among visible = Among::all, Among casters = Among::all) const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

/// One ray a pixel through pixel centres, row after row from the bottom row, for a pinhole camera
/// given by its clip matrix; directions reach from the eye to the far side of the pixel's line.
/// Precondition: the matrix can be inverted.
std::vector<Ray> pixel_rays(const Camera& camera);

/// The ray through window coordinates (pixels; pixel centres at .5, the bottom row first).
Ray window_ray(const Camera& camera, double x, double y);

}  // namespace gnomon::pipeline
