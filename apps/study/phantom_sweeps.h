// Sweeps of what is known of the real scene: its phantoms' shapes and places, and its light's.
#pragma once

#include <memory>

#include "apps/study/desk_scene.h"
#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_phantom_sweeps(Sweeps& sweeps, const std::shared_ptr<Desk>& desk);

}  // namespace gnomon::apps::study
