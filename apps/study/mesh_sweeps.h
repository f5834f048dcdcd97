// Sweeps of how broken a caster's mesh is: triangles that are missing, turned, doubled or torn off,
// and triangles without any order.
#pragma once

#include "apps/study/stability.h"

namespace gnomon::apps::study {

void add_mesh_sweeps(Sweeps& sweeps, int threads);

}  // namespace gnomon::apps::study
