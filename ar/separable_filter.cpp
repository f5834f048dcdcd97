#include "ar/separable_filter.h"

#include <algorithm>
#include <cmath>

#include "raster/check.h"

namespace gnomon::ar {

int border_index(int i, int size, Border border) {
  if (border == Border::replicate) return std::clamp(i, 0, size - 1);
  if (size == 1) return 0;
  const int period = 2 * (size - 1);
  const int wrapped = ((i % period) + period) % period;
  return wrapped < size ? wrapped : period - wrapped;
}

Kernel gaussian_kernel(double sigma, int radius) {
  Kernel kernel;
  double sum = 0.0;
  for (int x = -radius; x <= radius; ++x) {
    kernel.push_back(std::exp(-x * x / (2.0 * sigma * sigma)));
    sum += kernel.back();
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

template <class T>
Plane<T> filter_band(const Plane<T>& band, const Kernel& horizontal, const Kernel& vertical,
                     int halo, Border border) {
  const int r = radius(horizontal), rv = radius(vertical), width = band.width;
  raster::require(rv <= halo && band.height > 2 * halo, "a band's halo covers its filter");
  Plane<T> across(width, band.height);
  std::vector<T> padded(static_cast<std::size_t>(width) + 2 * r);
  for (int y = 0; y < band.height; ++y) {
    const T* in = band.row(y);
    for (int x = -r; x < 0; ++x) padded[x + r] = in[border_index(x, width, border)];
    std::copy(in, in + width, padded.begin() + r);
    for (int x = width; x < width + r; ++x) padded[x + r] = in[border_index(x, width, border)];
    T* out = across.row(y);
    for (std::size_t i = 0; i < horizontal.size(); ++i) {
      const T weight = static_cast<T>(horizontal[i]);
      const T* source = padded.data() + i;
      for (int x = 0; x < width; ++x) out[x] += weight * source[x];
    }
  }
  Plane<T> result(width, band.height - 2 * halo);
  for (int y = 0; y < result.height; ++y) {
    T* out = result.row(y);
    for (std::size_t i = 0; i < vertical.size(); ++i) {
      const T weight = static_cast<T>(vertical[i]);
      const T* source = across.row(y + halo - rv + static_cast<int>(i));
      for (int x = 0; x < width; ++x) out[x] += weight * source[x];
    }
  }
  return result;
}

template Plane<float> filter_band(const Plane<float>&, const Kernel&, const Kernel&, int, Border);
template Plane<double> filter_band(const Plane<double>&, const Kernel&, const Kernel&, int, Border);

void for_each_band(int height, const std::function<void(int, int)>& work) {
  // Rows a band: enough to make its halo a small part of the work, few enough for the caches.
  constexpr int kBandRows = 64;
  for (int y = 0; y < height; y += kBandRows) work(y, std::min(kBandRows, height - y));
}

}  // namespace gnomon::ar
