// Sweeps of pictures that tags are hard to see in.
#pragma once

#include <memory>

#include "apps/study/desk_scene.h"
#include "apps/study/stability.h"

namespace gnomon::apps::study {

/// Of each kind of damage three sweeps: lost frames, shadows that flicker, and that are misplaced.
void add_tag_sweeps(Sweeps& sweeps, const std::shared_ptr<Desk>& desk);

}  // namespace gnomon::apps::study
