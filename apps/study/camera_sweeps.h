// Sweeps of where the camera is: through a shadow volume, and how far its planes are apart.
#pragma once

#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_camera_sweeps(Sweeps& sweeps, int threads);

}  // namespace gnomon::apps::study
