#include "ar/response_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "ar/dark_response.h"
#include "ar/error.h"
#include "raster/executor.h"

namespace gnomon::ar {
namespace {

constexpr int kValues = 256;
/// 255 stands for everything beyond; dark values are found in another way (dark_response.h).
constexpr int kLowest = static_cast<int>(kFirstKnownValue), kHighest = 254;
/// Pixels of a set are summed in so many pieces, whatever the number of threads.
constexpr std::size_t kPieces = 16;
/// Neighbours say the same; every other pixel is plenty.
constexpr std::size_t kPixelStep = 2;
/// The smoothness term is a guess, the pixels are measurements: it must not be needed by more.
constexpr double kLargestTimeRatio = 1.5;

/// How much a value is worth: the logarithm of a dark one is coarse, since a step of one value is a
/// large part of it, and noise near saturation is cut off on one side.
double weight_of(int value) {
  if (value < kLowest || value > kHighest) return 0.0;
  const double coarse = value / 255.0;
  const double cut = std::min(1.0, (255.0 - value) / 12.0);
  return coarse * coarse * cut;
}

/// The normal equations of one channel's curve.
struct Equations {
  std::vector<double> matrix = std::vector<double>(kValues * kValues, 0.0);
  std::vector<double> right = std::vector<double>(kValues, 0.0);
  double weight = 0.0;

  void add(const Equations& other) {
    for (std::size_t i = 0; i < matrix.size(); ++i) matrix[i] += other.matrix[i];
    for (std::size_t i = 0; i < right.size(); ++i) right[i] += other.right[i];
    weight += other.weight;
  }
};

/// A pixel's exposures. Its own log radiance is the weighted mean of g(value) - log time; put in
/// the place of the unknown, what is left is quadratic in g alone.
struct Observation {
  std::size_t value;
  double weight, log_time;
};

void add_pixel(Equations& equations, std::span<const Observation> seen) {
  double total = 0.0, mean_time = 0.0;
  for (const Observation& o : seen) {
    total += o.weight;
    mean_time += o.weight * o.log_time;
  }
  mean_time /= total;
  equations.weight += total;
  for (const Observation& a : seen) {
    double* row = equations.matrix.data() + a.value * kValues;
    row[a.value] += a.weight;
    for (const Observation& b : seen) row[b.value] -= a.weight * b.weight / total;
    equations.right[a.value] += a.weight * (a.log_time - mean_time);
  }
}

void add_pixels(Equations& equations, const Brackets& set, std::size_t channel, std::size_t first,
                std::size_t last) {
  std::array<double, kValues> weights{};
  for (int v = 0; v < kValues; ++v) weights[static_cast<std::size_t>(v)] = weight_of(v);
  std::vector<double> log_times;
  for (const Exposure& e : set.exposures) log_times.push_back(std::log(e.time_s));
  std::vector<Observation> seen;
  for (std::size_t i = first; i < last; i += kPixelStep) {
    seen.clear();
    for (std::size_t k = 0; k < set.exposures.size(); ++k) {
      const std::size_t value = set.exposures[k].picture.pixels[3 * i + channel];
      if (weights[value] > 0.0) seen.push_back({value, weights[value], log_times[k]});
    }
    if (seen.size() > 1) add_pixel(equations, seen);
  }
}

Equations gather(std::span<const Brackets> sets, std::size_t channel, int threads) {
  std::vector<Equations> pieces(sets.size() * kPieces);
  raster::for_each_chunk(pieces.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Brackets& set = sets[p / kPieces];
      const std::size_t pixels = static_cast<std::size_t>(set.width()) * set.height();
      const std::size_t k = p % kPieces;
      add_pixels(pieces[p], set, channel, pixels * k / kPieces, pixels * (k + 1) / kPieces);
    }
  });
  Equations sum;
  for (const Equations& piece : pieces) sum.add(piece);
  return sum;
}

/// The log exposure of each value, up to a constant.
std::vector<double> solve(Equations& equations, double smoothness) {
  const double lambda = smoothness * equations.weight;
  auto entry = [&](int row, int column) -> double& {
    return equations.matrix[static_cast<std::size_t>(row * kValues + column)];
  };
  for (int v = kLowest + 1; v < kHighest; ++v) {
    // A power law bends, in values, most at the dark end: it is held the least there.
    const double w = lambda * std::pow(v / 255.0, 4.0);
    const std::array<double, 3> second{1.0, -2.0, 1.0};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        entry(v - 1 + a, v - 1 + b) +=
            w * second[static_cast<std::size_t>(a)] * second[static_cast<std::size_t>(b)];
  }
  // The constant that the exposures leave open, and the values that take no part.
  entry(128, 128) += equations.weight;
  for (int v = 0; v < kValues; ++v)
    if (v < kLowest || v > kHighest) entry(v, v) += 1.0;
  cv::Mat matrix(kValues, kValues, CV_64F, equations.matrix.data());
  cv::Mat right(kValues, 1, CV_64F, equations.right.data()), curve;
  cv::solve(matrix, right, curve, cv::DECOMP_CHOLESKY);
  return {curve.begin<double>(), curve.end<double>()};
}

/// Exposures from their logarithms: rising, 0 at value 0, 1 at 255.
std::array<double, 256> finished(const std::vector<double>& log_exposure,
                                 std::span<const Brackets> sets, std::size_t channel, int threads) {
  std::array<double, 256> curve{};
  for (int v = kLowest; v <= kHighest; ++v) {
    const auto at = static_cast<std::size_t>(v);
    // Noise may let neighbours fall by a hair.
    curve[at] = std::max(std::exp(log_exposure[at]), curve[at - 1] * (1.0 + 1e-5));
  }
  // 255 holds all that lies beyond the end: the curve goes on as it comes in.
  curve[255] = curve[254] + (curve[254] - curve[244]) / 10.0;
  fit_dark_values(sets, channel, threads, curve);
  for (double& exposure : curve) exposure /= curve[255];
  return curve;
}

void check_times(const Brackets& set, const ExposureCurve& curve) {
  const std::vector<double> ratios = time_ratios(set, curve);
  std::size_t worst = 0;
  const auto size = [&](std::size_t k) { return std::abs(std::log(ratios[k])); };
  for (std::size_t k = 1; k < ratios.size(); ++k)
    if (size(k) > size(worst)) worst = k;
  if (size(worst) > std::log(kLargestTimeRatio))
    throw InputError(
        fmt::format("{}: its time is given as {:g} s, but the other exposures say {:g} s",
                    set.exposures[worst].file.string(), set.exposures[worst].time_s,
                    set.exposures[worst].time_s * ratios[worst]));
}

}  // namespace

std::vector<double> time_ratios(const Brackets& brackets, const ExposureCurve& curve) {
  constexpr std::size_t kStep = 29;
  const std::size_t pixels = static_cast<std::size_t>(brackets.width()) * brackets.height();
  std::array<double, 256> logs{};
  for (std::size_t v = 1; v < 256; ++v) logs[v] = std::log(curve.exposure_from_value[1][v]);
  std::vector<double> ratios;
  for (std::size_t k = 0; k < brackets.exposures.size(); ++k) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < pixels; i += kStep) {
      const auto value_in = [&](std::size_t e) -> std::size_t {
        return brackets.exposures[e].picture.pixels[3 * i + 1];
      };
      const auto is_sure = [](std::size_t value) { return value >= 16 && value <= 240; };
      if (!is_sure(value_in(k))) continue;
      for (std::size_t e = 0; e < brackets.exposures.size(); ++e)
        if (e != k && is_sure(value_in(e)))
          differences.push_back(
              logs[value_in(k)] - logs[value_in(e)] +
              std::log(brackets.exposures[e].time_s / brackets.exposures[k].time_s));
    }
    if (differences.empty()) {
      ratios.push_back(1.0);
      continue;
    }
    const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
    std::nth_element(differences.begin(), middle, differences.end());
    ratios.push_back(std::exp(*middle));
  }
  return ratios;
}

ExposureCurve fit_response(std::span<const Brackets> sets, const ResponseFitOptions& options) {
  ExposureCurve curve;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    Equations equations = gather(sets, channel, options.threads);
    if (!(equations.weight > 0.0))
      throw InputError(
          fmt::format("{}: no pixel lies between black and saturation in two exposures, so they "
                      "tell no response",
                      sets.front().list.string()));
    curve.exposure_from_value[channel] =
        finished(solve(equations, options.smoothness), sets, channel, options.threads);
  }
  for (const Brackets& set : sets) check_times(set, curve);
  return curve;
}

}  // namespace gnomon::ar
