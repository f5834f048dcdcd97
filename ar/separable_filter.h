// Separable filters over a band of a picture's rows, for measures that look at neighbourhoods.
// A band carries `halo` rows above and below the rows that it stands for, so memory does not grow
// with the picture's height.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace gnomon::ar {

/// Rows of float or double.
template <class T>
struct Plane {
  int width = 0, height = 0;
  std::vector<T> values;

  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * h) {}
  T* row(int y) { return values.data() + static_cast<std::size_t>(y) * width; }
  const T* row(int y) const { return values.data() + static_cast<std::size_t>(y) * width; }
};

/// An odd number of weights, the middle one at the pixel itself.
using Kernel = std::vector<double>;

inline int radius(const Kernel& kernel) { return static_cast<int>(kernel.size()) / 2; }

/// What lies outside the picture: its last row and column again (a a|a b c), or its mirror image
/// without the last ones (c b|a b c).
enum class Border { replicate, reflect_101 };

/// The row or column inside [0, size) that stands for `i`, which may lie any distance outside.
int border_index(int i, int size, Border border);

/// Weights exp(-x^2 / (2 sigma^2)) at -radius..radius, of sum 1.
Kernel gaussian_kernel(double sigma, int radius);

/// Filters rows, then columns. `band` has `halo` more rows above and below than the result.
/// Precondition: the radius of `vertical` is at most `halo`.
template <class T>
Plane<T> filter_band(const Plane<T>& band, const Kernel& horizontal, const Kernel& vertical,
                     int halo, Border border);

/// Calls work(first_row, rows) for bands that cover `height` rows.
void for_each_band(int height, const std::function<void(int, int)>& work);

}  // namespace gnomon::ar
