// The sweeps as one HTML file that works without a network, opened from disk.
#pragma once

#include <string>

#include "apps/study/stability_part.h"

namespace gnomon::apps::study {

/// A map a sweep: a row a method, a column a value, the colour the share that is wrong, and a red
/// line where a method gives up.
std::string stability_page(const StabilityPart& part);

}  // namespace gnomon::apps::study
