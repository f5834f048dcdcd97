// Scenes without files that are charted beside those a user names: each asks for something that
// some method is weak in.
#pragma once

#include <vector>

#include "apps/study/shadow_trial.h"

namespace gnomon::apps::study {

/// Always the same ones. Closed bodies; many casters; thin things under a low sun; meshes that are
/// not closed; an eye in a shadow; a lamp among things; a wide field with small casters.
std::vector<View> generated_views(int width, int height);

}  // namespace gnomon::apps::study
