// What stands on the lab's floor.
#pragma once

#include "apps/inspector/lab_state.h"
#include "pipeline/scene.h"

namespace gnomon::apps::inspector {

/// A floor that receives, the stage's object at the place that the state says, and a lamp.
pipeline::Scene lab_scene(const LabState& state);

pipeline::Camera lab_camera(const LabState& state);

}  // namespace gnomon::apps::inspector
