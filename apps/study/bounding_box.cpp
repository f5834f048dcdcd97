#include "apps/study/bounding_box.h"

#include <utility>

#include "pipeline/bounds.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

std::shared_ptr<const pipeline::Model> bounding_box(const pipeline::Model& model) {
  pipeline::Bounds bounds;
  for (const pipeline::Part& part : model.parts)
    for (const glm::vec4& p : part.mesh.positions) bounds.add(glm::dvec3(p));
  pipeline::Mesh box = pipeline::flat_box_mesh(glm::vec3((bounds.high - bounds.low) * 0.5));
  for (glm::vec4& p : box.positions) p += glm::vec4(glm::vec3(bounds.center()), 0.0f);
  return pipeline::model_of(std::move(box));
}

}  // namespace gnomon::apps::study
