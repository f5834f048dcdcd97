// Sweeps of what the camera's depth buffer holds: how far its planes are apart, and a far plane
// that comes closer than volumes end.
#pragma once

#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_depth_sweeps(Sweeps& sweeps, int threads);

}  // namespace gnomon::apps::study
