// Lighting and depth lookups as the vector kernels want them: plain numbers, and which terms cannot
// change a bit of a colour and may be left out.
#pragma once

#include <cstddef>

#include "raster/kernels.h"
#include "raster/shading.h"

namespace gnomon::raster {

/// A vector's components.
template <class Vector, std::size_t kCount>
void copy(const Vector& from, float (&to)[kCount]) {
  for (std::size_t i = 0; i < kCount; ++i) to[i] = from[static_cast<int>(i)];
}

LookupTerms make_lookup(const DepthLookup& lookup);
LitLight make_light(const Light& light);
LitTerms make_lit(const Lit& lit);

}  // namespace gnomon::raster
