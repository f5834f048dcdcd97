// Float32 operations, each rounded once, in a form that no compiler can fuse and no processor
// approximates: one operation in double, then a rounding. Double's 53 bits are more than twice 24
// and two, so the second rounding changes nothing (Figueroa 1995).
#pragma once

#include <cmath>

namespace gnomon::reference::float32 {

inline float plus(float a, float b) {
  return static_cast<float>(static_cast<double>(a) + static_cast<double>(b));
}
inline float times(float a, float b) {
  return static_cast<float>(static_cast<double>(a) * static_cast<double>(b));
}
inline float over(float a, float b) {
  return static_cast<float>(static_cast<double>(a) / static_cast<double>(b));
}
inline float square_root(float a) { return static_cast<float>(std::sqrt(static_cast<double>(a))); }

}  // namespace gnomon::reference::float32
