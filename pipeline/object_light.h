// Virtual objects in real light (Gibson 2003, section 9): diffuse from an irradiance volume,
// specular from the probe, seen through the material's own lobe.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/irradiance_volume.h"
#include "pipeline/lit_scene.h"
#include "pipeline/placed_object.h"

namespace gnomon::pipeline {

/// Radiance of virtual objects at their vertices, with nothing hidden by virtual objects: one list
/// an object, of all its meshes' vertices in turn.
using ObjectRadiance = std::vector<std::vector<glm::vec3>>;

/// The reflectance that a display-referred colour (Material) stands for: sRGB decoded.
glm::vec3 linear_color(const glm::vec3& srgb);

/// Refers to the scene.
class ObjectLight {
 public:
  ObjectLight(const LitScene& scene, const PatchVisibility& visibility,
              const IrradianceVolumeOptions& options = {});

  /// Textures are left out. The probe's light is taken as distant; without a probe nothing mirrors.
  ObjectRadiance radiance(std::span<const PlacedObject> objects, const glm::vec3& eye_world,
                          int threads = 0);

  const IrradianceVolume& volume() const { return volume_; }

 private:
  const DirectionMap& blurred(int shininess);

  const LitScene& scene_;
  IrradianceVolume volume_;
  /// The probe as a Blinn-Phong lobe of that exponent sees it, made the first time.
  std::map<int, DirectionMap> blurred_;
};

/// The mean of the map over directions, weighted by max(0, cosine)^exponent about each of the
/// result's directions; of a quarter of the size, at most 64 x 32.
DirectionMap blur(const DirectionMap& probe, double exponent);

}  // namespace gnomon::pipeline
