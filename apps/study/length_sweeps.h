// Sweeps of how long volumes are.
#pragma once

#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_length_sweeps(Sweeps& sweeps, int threads);

}  // namespace gnomon::apps::study
