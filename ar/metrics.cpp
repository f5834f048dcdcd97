#include "ar/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "ar/separable_filter.h"
#include "raster/check.h"

namespace gnomon::ar {
namespace {

constexpr int kColors = 3, kAlpha = 3;

int value(const std::uint8_t* pixel, int channels, int channel) {
  if (channel == kAlpha) return channels == 4 ? pixel[kAlpha] : 255;
  return channels == 1 ? pixel[0] : pixel[channel];
}

void require_comparable(const Image& a, const Image& b, const Image* mask) {
  const auto whole = [](const Image& image) {
    return image.width >= 1 && image.height >= 1 &&
           (image.channels == 1 || image.channels == 3 || image.channels == 4) &&
           image.pixels.size() ==
               static_cast<std::size_t>(image.width) * image.height * image.channels;
  };
  const auto same_size = [&](const Image& image) {
    return image.width == a.width && image.height == a.height;
  };
  raster::require(whole(a) && whole(b) && (mask == nullptr || whole(*mask)),
                  "a picture that is compared has pixels, of 1, 3 or 4 channels");
  raster::require(same_size(b) && (mask == nullptr || same_size(*mask)),
                  "pictures that are compared have the same size");
}

/// Calls visit(pixel of a, pixel of b) for the pixels compared and returns their number.
template <class Visit>
std::int64_t for_each_pixel(const Image& a, const Image& b, const Image* mask, Visit visit) {
  std::int64_t count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (!picked(mask, x, y)) continue;
      ++count;
      visit(a.at(x, y), b.at(x, y));
    }
  }
  raster::require(count > 0, "a mask picks at least one pixel");
  return count;
}

/// Variances are differences of large sums, so they are taken in double precision.
using DoublePlane = Plane<double>;

/// One channel of the rows [first - halo, first + rows + halo).
DoublePlane channel_band(const Image& image, int channel, int first, int rows, int halo) {
  DoublePlane plane(image.width, rows + 2 * halo);
  for (int y = 0; y < plane.height; ++y) {
    const int source = border_index(first - halo + y, image.height, Border::reflect_101);
    for (int x = 0; x < image.width; ++x) {
      plane.row(y)[x] = value(image.at(x, source), image.channels, channel);
    }
  }
  return plane;
}

DoublePlane product(const DoublePlane& a, const DoublePlane& b) {
  DoublePlane result(a.width, a.height);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] = a.values[i] * b.values[i];
  }
  return result;
}

/// The five window moments of a band of one channel.
struct Moments {
  DoublePlane mean_a, mean_b, square_a, square_b, cross;
};

Moments moments(const DoublePlane& a, const DoublePlane& b, const Kernel& window) {
  const int halo = radius(window);
  const auto smooth = [&](const DoublePlane& plane) {
    return filter_band(plane, window, window, halo, Border::reflect_101);
  };
  return {smooth(a), smooth(b), smooth(product(a, a)), smooth(product(b, b)),
          smooth(product(a, b))};
}

double similarity(const Moments& m, std::size_t i) {
  constexpr double kC1 = 0.01 * 255.0 * 0.01 * 255.0, kC2 = 0.03 * 255.0 * 0.03 * 255.0;
  const double mean_a = m.mean_a.values[i], mean_b = m.mean_b.values[i];
  const double variance_a = m.square_a.values[i] - mean_a * mean_a;
  const double variance_b = m.square_b.values[i] - mean_b * mean_b;
  const double covariance = m.cross.values[i] - mean_a * mean_b;
  return (2.0 * mean_a * mean_b + kC1) * (2.0 * covariance + kC2) /
         ((mean_a * mean_a + mean_b * mean_b + kC1) * (variance_a + variance_b + kC2));
}

bool is_grey(const Image& image) {
  if (image.channels == 1) return true;
  for (std::size_t i = 0; i + 2 < image.pixels.size();
       i += static_cast<std::size_t>(image.channels)) {
    const std::uint8_t* pixel = image.pixels.data() + i;
    if (pixel[0] != pixel[1] || pixel[1] != pixel[2]) return false;
  }
  return true;
}

}  // namespace

Difference difference(const Image& a, const Image& b, const Image* mask) {
  require_comparable(a, b, mask);
  Difference result;
  std::int64_t squares = 0;
  result.pixels =
      for_each_pixel(a, b, mask, [&](const std::uint8_t* in_a, const std::uint8_t* in_b) {
        int largest = 0;
        for (int c = 0; c <= kAlpha; ++c) {
          const int error = std::abs(value(in_a, a.channels, c) - value(in_b, b.channels, c));
          if (c != kAlpha) squares += error * error;
          largest = std::max(largest, error);
        }
        result.differing += largest > 0 ? 1 : 0;
        result.largest = std::max(result.largest, largest);
      });
  result.rmse =
      std::sqrt(static_cast<double>(squares) / (static_cast<double>(result.pixels) * kColors));
  result.psnr = squares == 0 ? std::numeric_limits<double>::infinity()
                             : 20.0 * std::log10(255.0 / result.rmse);
  return result;
}

FloatDifference difference(const FloatImage& a, const FloatImage& b, const Image* mask) {
  raster::require(a.width >= 1 && a.height >= 1 && a.width == b.width && a.height == b.height &&
                      (mask == nullptr || (mask->width == a.width && mask->height == a.height)),
                  "pictures that are compared have pixels and the same size");
  FloatDifference result;
  double squares = 0.0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (!picked(mask, x, y)) continue;
      double largest = 0.0;
      for (int c = 0; c < kColors; ++c) {
        const double error = std::abs(double{a.at(x, y)[c]} - double{b.at(x, y)[c]});
        squares += error * error;
        largest = std::max(largest, error);
      }
      ++result.pixels;
      result.differing += largest > 0.0 ? 1 : 0;
      result.largest = std::max(result.largest, largest);
    }
  }
  raster::require(result.pixels > 0, "a mask picks at least one pixel");
  result.rmse = std::sqrt(squares / (static_cast<double>(result.pixels) * kColors));
  return result;
}

std::optional<double> mask_iou(const Image& a, const Image& b, const Image* mask) {
  require_comparable(a, b, mask);
  if (!is_grey(a) || !is_grey(b)) return std::nullopt;
  std::int64_t both = 0, either = 0;
  for_each_pixel(a, b, mask, [&](const std::uint8_t* in_a, const std::uint8_t* in_b) {
    const bool set_a = in_a[0] >= kMaskThreshold, set_b = in_b[0] >= kMaskThreshold;
    both += set_a && set_b ? 1 : 0;
    either += set_a || set_b ? 1 : 0;
  });
  return either == 0 ? 1.0 : static_cast<double>(both) / static_cast<double>(either);
}

double ssim(const Image& a, const Image& b, const Image* mask) {
  require_comparable(a, b, mask);
  const Kernel window = gaussian_kernel(1.5, 5);
  double sum = 0.0;
  std::int64_t count = 0;
  for_each_band(a.height, [&](int first, int rows) {
    for (int c = 0; c < kColors; ++c) {
      const Moments m = moments(channel_band(a, c, first, rows, radius(window)),
                                channel_band(b, c, first, rows, radius(window)), window);
      for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < a.width; ++x) {
          if (!picked(mask, x, first + y)) continue;
          sum += similarity(m, static_cast<std::size_t>(y) * a.width + x);
          ++count;
        }
      }
    }
  });
  raster::require(count > 0, "a mask picks at least one pixel");
  return sum / static_cast<double>(count);
}

}  // namespace gnomon::ar
