// A sweep of how many shadows are subtracted one after the other (Gibson 2003, section 8: "many
// faint shadows" are lost in eight bits).
#pragma once

#include <memory>

#include "apps/study/soft_room.h"
#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_pass_sweeps(Sweeps& sweeps, const std::shared_ptr<SoftRoom>& room);

}  // namespace gnomon::apps::study
