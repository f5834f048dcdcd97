// How much two pictures differ, in numbers: exact counts, errors of values, and the structural
// similarity of Wang et al. 2004. FLIP has its own header (ar/flip.h).
//
// A picture with one channel counts as grey (r = g = b), one without alpha as opaque. A mask picks
// pixels: those whose first channel is at least 128; absent, every pixel is compared.
#pragma once

#include <cstdint>
#include <optional>

#include "ar/image.h"
#include "ar/image_file.h"

namespace gnomon::ar {

/// Values from which a mask is set.
inline constexpr int kMaskThreshold = 128;

struct Difference {
  /// Pixels compared, and those of them that differ in any channel, alpha included.
  std::int64_t pixels = 0, differing = 0;
  /// The largest difference of a channel, alpha included, 0 to 255.
  int largest = 0;
  /// Root mean square of the differences of r, g and b, 0 to 255.
  double rmse = 0.0;
  /// 20 log10(255 / rmse) in decibels; infinite if the colours are equal.
  double psnr = 0.0;
};

/// Preconditions of all functions here: both pictures (and the mask) have the same size, at least
/// one pixel, and the mask picks at least one.
Difference difference(const Image& a, const Image& b, const Image* mask = nullptr);

/// The same of two pictures of floats, in their own unit.
struct FloatDifference {
  std::int64_t pixels = 0, differing = 0;
  double largest = 0.0, rmse = 0.0;
};
FloatDifference difference(const FloatImage& a, const FloatImage& b, const Image* mask = nullptr);

/// Pixels set in both over pixels set in either, a pixel being set where it is at least 128; 1 if
/// no pixel is set in either. Nothing if one of the pictures is no mask, that is, has a pixel that
/// is not grey.
std::optional<double> mask_iou(const Image& a, const Image& b, const Image* mask = nullptr);

/// Mean structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004), 1 for equal pictures.
/// Variant: 8-bit values, K1 = 0.01, K2 = 0.03, L = 255; Gaussian window of 11x11 pixels with
/// sigma 1.5, population variances, borders mirrored without the last pixel; the map has the
/// picture's own size and its mean is taken over the pixels compared and over r, g and b.
double ssim(const Image& a, const Image& b, const Image* mask = nullptr);

/// True where the mask picks the pixel, or everywhere without one.
inline bool picked(const Image* mask, int x, int y) {
  return mask == nullptr || mask->at(x, y)[0] >= kMaskThreshold;
}

}  // namespace gnomon::ar
