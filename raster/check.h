// Misuse of the library: an always-on check per call that names the broken rule.
#pragma once

#include <stdexcept>

namespace gnomon::raster {

/// Throws std::invalid_argument with `rule` unless `holds`.
inline void require(bool holds, const char* rule) {
  if (!holds) throw std::invalid_argument(rule);
}

}  // namespace gnomon::raster
