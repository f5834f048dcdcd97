// Sweeps of a camera response that is not the camera's.
#pragma once

#include <memory>

#include "apps/study/desk_scene.h"
#include "apps/study/soft_room.h"
#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_response_sweeps(Sweeps& sweeps, const std::shared_ptr<SoftRoom>& room,
                         const std::shared_ptr<Desk>& desk);

}  // namespace gnomon::apps::study
