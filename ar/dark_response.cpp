#include "ar/dark_response.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "raster/executor.h"

namespace gnomon::ar {
namespace {

/// Exposures are sorted into bins of an eighth of a stop, below the first known value's.
constexpr int kBinsAStop = 8, kBins = 10 * kBinsAStop;
/// Pixels are looked at in so many pieces, whatever the number of threads.
constexpr std::size_t kPieces = 16;
/// A median of fewer values is noise.
constexpr std::uint32_t kLeastPixels = 64;
/// Beyond, saturation cuts noise off.
constexpr std::size_t kBrightest = 245;

struct Histograms {
  std::vector<std::array<std::uint32_t, 256>> bins{static_cast<std::size_t>(kBins)};
};

/// In stops: of each value's exposure, and of each exposure's time.
struct Logarithms {
  std::array<double, 256> value{};
  std::vector<double> time;

  Logarithms(const Brackets& set, const std::array<double, 256>& curve) {
    for (std::size_t v = kFirstKnownValue; v < 256; ++v) value[v] = std::log2(curve[v]);
    for (const Exposure& e : set.exposures) time.push_back(std::log2(e.time_s));
  }
};

void count_pixels(const Brackets& set, std::size_t channel, const Logarithms& logs,
                  std::size_t first, std::size_t last, Histograms& counts) {
  for (std::size_t i = first; i < last; ++i) {
    // The longest exposure that is not saturated knows the pixel best.
    const auto value_in = [&](std::size_t k) -> std::size_t {
      return set.exposures[k].picture.pixels[3 * i + channel];
    };
    std::size_t best = set.exposures.size();
    for (std::size_t k = 0; k < set.exposures.size(); ++k)
      if (value_in(k) >= kFirstKnownValue && value_in(k) <= kBrightest) best = k;
    if (best == set.exposures.size()) continue;
    const double stops_to_top =
        logs.value[value_in(best)] - logs.time[best] - logs.value[kFirstKnownValue];
    for (std::size_t k = 0; k < best; ++k) {
      const double stops = stops_to_top + logs.time[k];
      if (stops >= 0.0) break;
      const int bin = static_cast<int>(-stops * kBinsAStop);
      if (bin < kBins) ++counts.bins[static_cast<std::size_t>(bin)][value_in(k)];
    }
  }
}

/// Between values, as if each stood for all that round to it; 0 where it is black.
double median(const std::array<std::uint32_t, 256>& counts, std::uint32_t total) {
  double below = 0.0;
  const double half = 0.5 * total;
  for (std::size_t v = 0; v < counts.size(); ++v) {
    if (below + counts[v] >= half)
      return v == 0 ? 0.0 : static_cast<double>(v) - 0.5 + (half - below) / counts[v];
    below += counts[v];
  }
  return 0.0;
}

struct Point {
  double value, log_exposure;
};

}  // namespace

void fit_dark_values(std::span<const Brackets> sets, std::size_t channel, int threads,
                     std::array<double, 256>& curve) {
  std::vector<Histograms> pieces(sets.size() * kPieces);
  raster::for_each_chunk(pieces.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Brackets& set = sets[p / kPieces];
      const std::size_t pixels = static_cast<std::size_t>(set.width()) * set.height();
      const Logarithms logs(set, curve);
      const std::size_t k = p % kPieces;
      count_pixels(set, channel, logs, pixels * k / kPieces, pixels * (k + 1) / kPieces, pieces[p]);
    }
  });
  const double log_top = std::log(curve[kFirstKnownValue]);
  std::vector<Point> points{{static_cast<double>(kFirstKnownValue), log_top}};
  for (int bin = 0; bin < kBins; ++bin) {
    std::array<std::uint32_t, 256> counts{};
    std::uint32_t total = 0;
    for (const Histograms& piece : pieces)
      for (std::size_t v = 0; v < 256; ++v) {
        counts[v] += piece.bins[static_cast<std::size_t>(bin)][v];
        total += piece.bins[static_cast<std::size_t>(bin)][v];
      }
    if (total < kLeastPixels) continue;
    const double value = median(counts, total);
    if (value <= 0.5) break;
    if (value < points.back().value - 0.05)
      points.push_back({value, log_top - (bin + 0.5) * std::log(2.0) / kBinsAStop});
  }
  // Straight in logarithms between the medians, and beyond them as the curve comes in.
  const auto slope = [](const Point& high, const Point& low) {
    return (high.log_exposure - low.log_exposure) / (std::log(high.value) - std::log(low.value));
  };
  const Point above{2.0 * kFirstKnownValue, std::log(curve[2 * kFirstKnownValue])};
  const double last_slope =
      slope(points.size() > 4 ? points[points.size() - 5] : above, points.back());
  std::size_t k = 0;
  for (std::size_t v = kFirstKnownValue - 1; v >= 1; --v) {
    const auto value = static_cast<double>(v);
    while (k + 1 < points.size() && points[k + 1].value > value) ++k;
    const Point& from = points[k];
    const double rise = k + 1 < points.size() ? slope(from, points[k + 1]) : last_slope;
    curve[v] = std::exp(from.log_exposure + rise * (std::log(value) - std::log(from.value)));
    curve[v] = std::min(curve[v], curve[v + 1] * (1.0 - 1e-5));
  }
  curve[0] = 0.0;
}

}  // namespace gnomon::ar
