#include "pipeline/casters.h"

#include <algorithm>
#include <cstddef>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

template <class Belongs>
std::vector<bool> those(const Scene& scene, Belongs belongs) {
  std::vector<bool> in;
  in.reserve(scene.objects.size());
  for (const Object& object : scene.objects) in.push_back(belongs(object));
  return in;
}

}  // namespace

ShadowMethod shadow_method(const Scene& scene, const Light& light, const Object& object) {
  if (!object.casts) return ShadowMethod::none;
  if (light.shadow_of_object.empty()) return light.shadow;
  raster::require(light.shadow_of_object.size() == scene.objects.size(),
                  "a light names a shadow method for every object or for none");
  return light.shadow_of_object[static_cast<std::size_t>(&object - scene.objects.data())];
}

Casters::Casters(const Scene& scene)
    : first_(scene.objects.data()),
      in_(those(scene, [](const Object& object) { return object.casts; })) {}

Casters::Casters(const Scene& scene, const Light& light)
    : first_(scene.objects.data()), in_(those(scene, [&](const Object& object) {
        return shadow_method(scene, light, object) != ShadowMethod::none;
      })) {}

Casters::Casters(const Scene& scene, const Light& light, ShadowMethod method)
    : first_(scene.objects.data()), in_(those(scene, [&](const Object& object) {
        return method != ShadowMethod::none && shadow_method(scene, light, object) == method;
      })) {}

bool Casters::contains(const Object& object) const {
  return in_[static_cast<std::size_t>(&object - first_)];
}

bool Casters::empty() const { return std::ranges::find(in_, true) == in_.end(); }

}  // namespace gnomon::pipeline
