// Sweeps of what is set of a shadow map: its size, what it shows, and its bias.
#pragma once

#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_map_sweeps(Sweeps& sweeps, int threads);

}  // namespace gnomon::apps::study
