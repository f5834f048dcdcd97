// FLIP: the error that a person sees who switches back and forth between two pictures.
// Sources: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference
// Evaluator for Alternating Images", 2020; for high dynamic range Andersson, Nilsson, Shirley,
// Akenine-Moller, "Visualizing Errors in Rendered High Dynamic Range Images", 2021.
#pragma once

#include <vector>

#include "ar/image.h"
#include "ar/image_file.h"

namespace gnomon::ar {

/// Pixels in a degree of the viewer's field: a display of 3840 pixels in 0.7 m seen from 0.7 m.
inline constexpr double kDefaultPixelsPerDegree = 67.02064327658226;

/// One error a pixel, 0 (same) to 1, rows from the top.
struct ErrorMap {
  int width = 0, height = 0;
  std::vector<float> errors;
};

/// FLIP of two sRGB pictures; alpha does not count.
/// Preconditions: same size, at least one pixel, pixels_per_degree in [1, 1000].
ErrorMap flip(const Image& reference, const Image& test,
              double pixels_per_degree = kDefaultPixelsPerDegree);

/// Exposures at which two pictures of high dynamic range are compared, in stops.
struct Exposures {
  double first = 0.0, last = 0.0;
  int count = 2;
};

/// From the exposure that keeps the brightest pixel of `reference` below white to the one that
/// does so for its median, about one stop apart.
Exposures hdr_exposures(const FloatImage& reference);

/// FLIP of two pictures of linear light (Rec. 709 primaries): the largest error over exposures,
/// each tone-mapped with the ACES curve.
/// Negative values, which light does not have, go through the curve too (as in the authors'
/// program).
ErrorMap flip_hdr(const FloatImage& reference, const FloatImage& test, const Exposures& exposures,
                  double pixels_per_degree = kDefaultPixelsPerDegree);

/// Mean error, or that under a mask (ar/metrics.h), which picks at least one pixel.
double mean_error(const ErrorMap& map, const Image* mask = nullptr);

/// The map in the colours of "magma": black is 0, light yellow 1.
Image error_picture(const ErrorMap& map);

}  // namespace gnomon::ar
