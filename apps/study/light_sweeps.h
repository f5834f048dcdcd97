// Sweeps of where a light is: near, in and behind what casts and receives, and in a face's plane.
#pragma once

#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_light_sweeps(Sweeps& sweeps, int threads);

}  // namespace gnomon::apps::study
