// Every sweep, in the order in which they are shown.
#pragma once

#include "apps/study/stability.h"

namespace gnomon::apps::study {

/// Threads as in raster::ExecuteOptions.
Sweeps generated_sweeps(int threads);

}  // namespace gnomon::apps::study
