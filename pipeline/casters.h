// Which of a scene's objects cast a light's shadow.
#pragma once

#include <vector>

#include "pipeline/scene.h"

namespace gnomon::pipeline {

/// How the shadow that an object casts of a light is found: Light::shadow_of_object, or without it
/// Light::shadow; none for an object that does not cast.
ShadowMethod shadow_method(const Scene& scene, const Light& light, const Object& object);

/// A set of a scene's objects. Refers to the scene.
class Casters {
 public:
  /// All that cast.
  explicit Casters(const Scene& scene);
  /// All whose shadow of the light is found by any method.
  Casters(const Scene& scene, const Light& light);
  /// Those whose shadow of the light is found by this method.
  Casters(const Scene& scene, const Light& light, ShadowMethod method);

  /// Precondition: an element of the scene's own objects.
  bool contains(const Object& object) const;
  bool empty() const;

 private:
  const Object* first_;
  std::vector<bool> in_;
};

}  // namespace gnomon::pipeline
