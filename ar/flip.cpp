#include "ar/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "ar/metrics.h"
#include "ar/separable_filter.h"
#include "raster/check.h"

namespace gnomon::ar {
namespace {

using Color = std::array<float, 3>;

/// Rec. 709 to XYZ and the white that it gives; the rational numbers of the sRGB primaries,
/// rounded.
constexpr float kXyzFromRgb[3][3] = {{0.41239080f, 0.35758434f, 0.18048079f},
                                     {0.21263901f, 0.71516868f, 0.07219232f},
                                     {0.01933082f, 0.11919478f, 0.95053215f}};
constexpr float kRgbFromXyz[3][3] = {{3.24096994f, -1.53738318f, -0.49861076f},
                                     {-0.96924364f, 1.87596750f, 0.04155506f},
                                     {0.05563008f, -0.20397696f, 1.05697151f}};
constexpr Color kWhite{0.95045593f, 1.0f, 1.08905775f};

Color times(const float (&m)[3][3], const Color& c) {
  Color out{};
  for (int i = 0; i < 3; ++i) out[i] = m[i][0] * c[0] + m[i][1] * c[1] + m[i][2] * c[2];
  return out;
}

/// The linear opponent space in which contrast sensitivity is known (2020, section 4.1.1).
Color ycxcz_from_linear(const Color& rgb) {
  const Color xyz = times(kXyzFromRgb, rgb);
  const float x = xyz[0] / kWhite[0], y = xyz[1] / kWhite[1], z = xyz[2] / kWhite[2];
  return {116.0f * y - 16.0f, 500.0f * (x - y), 200.0f * (y - z)};
}

Color linear_from_ycxcz(const Color& c) {
  const float y = (c[0] + 16.0f) / 116.0f, x = y + c[1] / 500.0f, z = y - c[2] / 200.0f;
  return times(kRgbFromXyz, {x * kWhite[0], y * kWhite[1], z * kWhite[2]});
}

/// L*a*b* with the chroma of dark colours reduced (Hunt effect; 2020, section 4.1.2).
Color hunt_lab_from_linear(const Color& rgb) {
  const Color xyz = times(kXyzFromRgb, rgb);
  Color f{};
  for (int i = 0; i < 3; ++i) {
    constexpr float kDelta = 6.0f / 29.0f;
    const float t = xyz[i] / kWhite[i];
    f[i] =
        t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
  }
  const float lightness = 116.0f * f[1] - 16.0f;
  const float hunt = 0.01f * lightness;
  return {lightness, hunt * 500.0f * (f[0] - f[1]), hunt * 200.0f * (f[1] - f[2])};
}

float hyab_distance(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

constexpr float kColorExponent = 0.7f;

/// Maps a colour distance to [0, 1]: 0.4 of the largest to 0.95, the rest above (2020, section
/// 4.1.3).
float color_error(float distance) {
  static const float kLargest = std::pow(hyab_distance(hunt_lab_from_linear({0.0f, 1.0f, 0.0f}),
                                                       hunt_lab_from_linear({0.0f, 0.0f, 1.0f})),
                                         kColorExponent);
  constexpr float kKneeAt = 0.4f, kKneeError = 0.95f;
  const float error = std::pow(distance, kColorExponent), knee = kKneeAt * kLargest;
  if (error < knee) return kKneeError / knee * error;
  return std::min(1.0f, kKneeError + (error - knee) / (kLargest - knee) * (1.0f - kKneeError));
}

/// Contrast sensitivity of a channel as a sum of Gaussians, and detectors of edges and points.
struct Filters {
  Kernel luminance, red_green, blue_yellow_wide, blue_yellow_narrow;
  /// Parts of the two Gaussians in the blue-yellow filter's sum of weights.
  float narrow_part = 0.0f, wide_part = 0.0f;
  Kernel smooth, edge, point;
  int halo = 0;
};

/// Weights a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees, have this sum over the plane of pixels.
double csf_sum(double a, double b, int radius, double ppd) {
  double row = 0.0;
  for (int x = -radius; x <= radius; ++x) {
    row += std::exp(-std::numbers::pi * std::numbers::pi * x * x / (ppd * ppd * b));
  }
  return a * std::sqrt(std::numbers::pi / b) * row * row;
}

Kernel csf_kernel(double b, int radius, double ppd) {
  return gaussian_kernel(std::sqrt(b / 2.0) / std::numbers::pi * ppd, radius);
}

/// Scales positive weights to sum 1 and negative ones to sum -1.
Kernel balanced(Kernel weights) {
  double positive = 0.0, negative = 0.0;
  for (double w : weights) (w > 0.0 ? positive : negative) += w;
  for (double& w : weights) w /= w > 0.0 ? positive : -negative;
  return weights;
}

Filters make_filters(double ppd) {
  // 2020, table 1 (b in squared degrees).
  constexpr double kLuminanceB = 0.0047, kRedGreenB = 0.0053;
  constexpr double kWideA = 34.1, kWideB = 0.04, kNarrowA = 13.5, kNarrowB = 0.025;
  constexpr double kFeatureWidthDegrees = 0.082;
  Filters f;
  const int r = static_cast<int>(std::ceil(3.0 * std::sqrt(kWideB / 2.0) / std::numbers::pi * ppd));
  f.luminance = csf_kernel(kLuminanceB, r, ppd);
  f.red_green = csf_kernel(kRedGreenB, r, ppd);
  f.blue_yellow_wide = csf_kernel(kWideB, r, ppd);
  f.blue_yellow_narrow = csf_kernel(kNarrowB, r, ppd);
  const double narrow = csf_sum(kNarrowA, kNarrowB, r, ppd);
  const double wide = csf_sum(kWideA, kWideB, r, ppd);
  f.narrow_part = static_cast<float>(narrow / (narrow + wide));
  f.wide_part = static_cast<float>(wide / (narrow + wide));

  const double sigma = 0.5 * kFeatureWidthDegrees * ppd;
  const int feature_r = static_cast<int>(std::ceil(3.0 * sigma));
  Kernel edge, point;
  for (int x = -feature_r; x <= feature_r; ++x) {
    const double g = std::exp(-x * x / (2.0 * sigma * sigma));
    edge.push_back(-x * g);
    point.push_back((x * x / (sigma * sigma) - 1.0) * g);
  }
  f.smooth = gaussian_kernel(sigma, feature_r);
  f.edge = balanced(edge);
  f.point = balanced(point);
  f.halo = std::max(r, feature_r);
  return f;
}

using FloatPlane = Plane<float>;

/// Writes row y of a picture in linear light, values in [0, 1].
using LinearRows = std::function<void(int y, Color* row)>;

/// What FLIP knows of one picture in a band.
struct Features {
  /// Filtered as the eye does, in L*a*b* after Hunt.
  std::array<FloatPlane, 3> seen;
  FloatPlane edges, points;
};

FloatPlane length(const FloatPlane& x, const FloatPlane& y) {
  FloatPlane result(x.width, x.height);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
  }
  return result;
}

Features features(const LinearRows& source, int width, int height, int first, int rows,
                  const Filters& f) {
  std::array<FloatPlane, 3> opponent;
  for (FloatPlane& plane : opponent) plane = FloatPlane(width, rows + 2 * f.halo);
  FloatPlane lightness(width, rows + 2 * f.halo);
  std::vector<Color> line(static_cast<std::size_t>(width));
  for (int y = 0; y < lightness.height; ++y) {
    source(border_index(first - f.halo + y, height, Border::replicate), line.data());
    for (int x = 0; x < width; ++x) {
      const Color c = ycxcz_from_linear(line[x]);
      for (int i = 0; i < 3; ++i) opponent[i].row(y)[x] = c[i];
      lightness.row(y)[x] = (c[0] + 16.0f) / 116.0f;
    }
  }
  const auto filter = [&](const FloatPlane& plane, const Kernel& across, const Kernel& down) {
    return filter_band(plane, across, down, f.halo, Border::replicate);
  };
  Features result;
  result.seen = {filter(opponent[0], f.luminance, f.luminance),
                 filter(opponent[1], f.red_green, f.red_green),
                 filter(opponent[2], f.blue_yellow_wide, f.blue_yellow_wide)};
  const FloatPlane narrow = filter(opponent[2], f.blue_yellow_narrow, f.blue_yellow_narrow);
  for (std::size_t i = 0; i < narrow.values.size(); ++i) {
    const float blue_yellow =
        f.wide_part * result.seen[2].values[i] + f.narrow_part * narrow.values[i];
    Color rgb =
        linear_from_ycxcz({result.seen[0].values[i], result.seen[1].values[i], blue_yellow});
    for (float& channel : rgb) channel = std::clamp(channel, 0.0f, 1.0f);
    const Color lab = hunt_lab_from_linear(rgb);
    for (int c = 0; c < 3; ++c) result.seen[c].values[i] = lab[c];
  }
  result.edges = length(filter(lightness, f.edge, f.smooth), filter(lightness, f.smooth, f.edge));
  result.points =
      length(filter(lightness, f.point, f.smooth), filter(lightness, f.smooth, f.point));
  return result;
}

/// Colour error, amplified where an edge or a point is in one picture only (2020, section 4.3).
float pixel_error(const Features& a, const Features& b, std::size_t i) {
  const float feature = std::max(std::abs(a.edges.values[i] - b.edges.values[i]),
                                 std::abs(a.points.values[i] - b.points.values[i]));
  const float feature_error = std::min(1.0f, std::sqrt(feature / std::numbers::sqrt2_v<float>));
  const auto lab = [i](const Features& f) {
    return Color{f.seen[0].values[i], f.seen[1].values[i], f.seen[2].values[i]};
  };
  const float color = color_error(hyab_distance(lab(a), lab(b)));
  return std::pow(color, 1.0f - feature_error);
}

/// Raises each error of the map to that of these two pictures where it is larger.
void raise_errors(ErrorMap& map, const LinearRows& reference, const LinearRows& test,
                  const Filters& filters) {
  for_each_band(map.height, [&](int first, int rows) {
    const Features a = features(reference, map.width, map.height, first, rows, filters);
    const Features b = features(test, map.width, map.height, first, rows, filters);
    float* errors = map.errors.data() + static_cast<std::size_t>(first) * map.width;
    for (std::size_t i = 0; i < a.edges.values.size(); ++i) {
      errors[i] = std::max(errors[i], pixel_error(a, b, i));
    }
  });
}

void require_valid(bool same_size, int width, int height, double ppd) {
  raster::require(same_size && width >= 1 && height >= 1,
                  "pictures that are compared have pixels and the same size");
  raster::require(ppd >= 1.0 && ppd <= 1000.0, "pixels per degree lie in [1, 1000]");
}

ErrorMap zero_map(int width, int height) {
  return {width, height, std::vector<float>(static_cast<std::size_t>(width) * height)};
}

std::array<float, 256> linear_from_srgb_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double v = i / 255.0;
    table[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  }
  return table;
}

LinearRows srgb_rows(const Image& image) {
  static const std::array<float, 256> kTable = linear_from_srgb_table();
  return [&image](int y, Color* row) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.at(x, y);
      const bool grey = image.channels == 1;
      row[x] = {kTable[p[0]], kTable[p[grey ? 0 : 1]], kTable[p[grey ? 0 : 2]]};
    }
  };
}

/// The ACES curve as FLIP uses it: (a x^2 + b x) / (c x^2 + d x + e), x scaled by 0.6.
constexpr float kAcesA = 0.36f * 2.51f, kAcesB = 0.6f * 0.03f, kAcesC = 0.36f * 2.43f,
                kAcesD = 0.6f * 0.59f, kAcesE = 0.14f;

float tone_mapped(float x) {
  // The curve is past 1 here, on both sides; farther out it would only overflow.
  constexpr float kFarBeyondWhite = 1e6f;
  const float v = std::clamp(x, -kFarBeyondWhite, kFarBeyondWhite);
  return std::clamp((v * (kAcesA * v + kAcesB)) / (v * (kAcesC * v + kAcesD) + kAcesE), 0.0f, 1.0f);
}

LinearRows exposed_rows(const FloatImage& image, double stops) {
  const double scale = std::exp2(stops);
  return [&image, scale](int y, Color* row) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        row[x][c] = tone_mapped(static_cast<float>(image.at(x, y)[c] * scale));
      }
    }
  };
}

}  // namespace

ErrorMap flip(const Image& reference, const Image& test, double pixels_per_degree) {
  require_valid(reference.width == test.width && reference.height == test.height, test.width,
                test.height, pixels_per_degree);
  ErrorMap map = zero_map(test.width, test.height);
  raise_errors(map, srgb_rows(reference), srgb_rows(test), make_filters(pixels_per_degree));
  return map;
}

Exposures hdr_exposures(const FloatImage& reference) {
  raster::require(reference.width >= 1 && reference.height >= 1, "a picture has pixels");
  std::vector<float> luminance;
  luminance.reserve(reference.pixels.size() / 3);
  for (std::size_t i = 0; i + 2 < reference.pixels.size(); i += 3) {
    const float* p = reference.pixels.data() + i;
    luminance.push_back(kXyzFromRgb[1][0] * p[0] + kXyzFromRgb[1][1] * p[1] +
                        kXyzFromRgb[1][2] * p[2]);
  }
  // 2021, section 3: where the tone curve reaches 0.85.
  constexpr double kBelowWhite = 0.85;
  const double a = kAcesA - kBelowWhite * kAcesC, b = kAcesB - kBelowWhite * kAcesD,
               c = -kBelowWhite * kAcesE;
  const double bright = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
  const auto stops = [&](float value) {
    return std::log2(bright / std::max(value, std::numeric_limits<float>::epsilon()));
  };
  const auto middle = luminance.begin() + static_cast<std::ptrdiff_t>(luminance.size() / 2);
  std::nth_element(luminance.begin(), middle, luminance.end());
  const double last = stops(*middle);
  const double first = stops(*std::max_element(middle, luminance.end()));
  return {first, last, std::max(2, static_cast<int>(std::ceil(last - first)))};
}

ErrorMap flip_hdr(const FloatImage& reference, const FloatImage& test, const Exposures& exposures,
                  double pixels_per_degree) {
  require_valid(reference.width == test.width && reference.height == test.height, test.width,
                test.height, pixels_per_degree);
  raster::require(exposures.count >= 2, "there are at least two exposures");
  ErrorMap map = zero_map(test.width, test.height);
  const Filters filters = make_filters(pixels_per_degree);
  const double step = (exposures.last - exposures.first) / (exposures.count - 1);
  for (int i = 0; i < exposures.count; ++i) {
    const double stops = exposures.first + step * i;
    raise_errors(map, exposed_rows(reference, stops), exposed_rows(test, stops), filters);
  }
  return map;
}

double mean_error(const ErrorMap& map, const Image* mask) {
  raster::require(mask == nullptr || (mask->width == map.width && mask->height == map.height),
                  "a mask has the size of what it masks");
  double sum = 0.0;
  std::int64_t count = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (!picked(mask, x, y)) continue;
      sum += map.errors[static_cast<std::size_t>(y) * map.width + x];
      ++count;
    }
  }
  raster::require(count > 0, "a mask picks at least one pixel");
  return sum / static_cast<double>(count);
}

Image error_picture(const ErrorMap& map) {
  cv::Mat levels(map.height, map.width, CV_8U), colors;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const float error = map.errors[static_cast<std::size_t>(y) * map.width + x];
      levels.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(std::lround(std::clamp(error, 0.0f, 1.0f) * 255.0f));
    }
  }
  cv::applyColorMap(levels, colors, cv::COLORMAP_MAGMA);
  Image picture{map.width, map.height, 3, {}};
  picture.pixels.reserve(static_cast<std::size_t>(map.width) * map.height * 3);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const auto& bgr = colors.at<cv::Vec3b>(y, x);
      picture.pixels.insert(picture.pixels.end(), {bgr[2], bgr[1], bgr[0]});
    }
  }
  return picture;
}

}  // namespace gnomon::ar
