// A case as text, for whoever looks into a failure: a command a line with what its state differs
// from the defaults in, and a line a triangle with its window coordinates in 1/256 pixel, its depth
// and the clip coordinates that they come from.
#pragma once

#include <string>

#include "case.h"

namespace gnomon::peer {

std::string describe(const Case& described);

}  // namespace gnomon::peer
