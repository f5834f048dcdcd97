// A compare function on two values (OpenGL 4.6, section 17.3.3).
#pragma once

#include "raster/state.h"

namespace gnomon::raster {

/// Does "a func b" hold? Nothing but never, always and not_equal holds where one is not a number.
template <class T>
constexpr bool holds(CompareFunc func, T a, T b) {
  switch (func) {
    case CompareFunc::never:
      return false;
    case CompareFunc::less:
      return a < b;
    case CompareFunc::equal:
      return a == b;
    case CompareFunc::less_equal:
      return a <= b;
    case CompareFunc::greater:
      return a > b;
    case CompareFunc::not_equal:
      return a != b;
    case CompareFunc::greater_equal:
      return a >= b;
    case CompareFunc::always:
      return true;
  }
  return false;
}

}  // namespace gnomon::raster
