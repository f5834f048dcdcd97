// Growth as a picture: two log-log diagrams in one SVG file.
#pragma once

#include <string>

#include "bench/growth.h"

namespace gnomon::bench {

/// Time against triangles on the left, against pixels on the right; the legends state the slopes of
/// the last four points. Without a library: text that any browser shows.
std::string plot_svg(const Growth& growth);

}  // namespace gnomon::bench
