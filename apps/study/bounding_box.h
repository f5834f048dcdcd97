// The coarsest phantom there is.
#pragma once

#include <memory>

#include "pipeline/mesh.h"

namespace gnomon::apps::study {

/// The axis-aligned box about a model's vertices, as a closed mesh. Precondition: it has one.
std::shared_ptr<const pipeline::Model> bounding_box(const pipeline::Model& model);

}  // namespace gnomon::apps::study
