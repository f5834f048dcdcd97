// Buffers of a golden scene as pictures for people.
#pragma once

#include "ar/image.h"
#include "golden/scenes.h"

namespace gnomon::golden {

/// Three channels from the top row; floats are clamped to [0, 1] and rounded.
ar::Image color_picture(const Targets& targets);
/// Grey, nearer is lighter.
ar::Image depth_picture(const Targets& targets);
/// False colour with a legend.
ar::Image stencil_picture(const Targets& targets);

}  // namespace gnomon::golden
