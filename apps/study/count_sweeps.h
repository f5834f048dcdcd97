// Sweeps of how many shadow volumes lie over each other, past what eight bits of stencil count.
#pragma once

#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_count_sweeps(Sweeps& sweeps, int threads);

}  // namespace gnomon::apps::study
