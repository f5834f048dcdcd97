#include "ar/displacement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "raster/check.h"

namespace gnomon::ar {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A place to look at, from the pixel whose value is looked for.
struct Offset {
  int x = 0, y = 0;
  double distance = 0.0;
};

/// All within the radius, the nearest first. Lines between neighbours are looked at from one of
/// their ends, so the radius is a pixel more than that of the distances looked for.
std::vector<Offset> offsets_within(int radius) {
  std::vector<Offset> offsets;
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x)
      if (x * x + y * y <= radius * radius) offsets.push_back({x, y, std::hypot(x, y)});
  std::sort(offsets.begin(), offsets.end(), [](const Offset& a, const Offset& b) {
    return std::tuple(a.x * a.x + a.y * a.y, a.y, a.x) <
           std::tuple(b.x * b.x + b.y * b.y, b.y, b.x);
  });
  return offsets;
}

/// The least and the largest value of each channel in tiles as wide as the radius: a value that is
/// in none of the nine tiles about a pixel need not be looked for.
class TileRanges {
 public:
  TileRanges(const Image& picture, int side)
      : side_(side),
        channels_(picture.channels),
        columns_((picture.width + side - 1) / side),
        rows_((picture.height + side - 1) / side),
        ranges_(std::size_t(columns_) * rows_ * channels_, Range{255, 0}) {
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        for (int c = 0; c < channels_; ++c) {
          Range& range = ranges_[index(x / side, y / side, c)];
          range.least = std::min(range.least, picture.at(x, y)[c]);
          range.most = std::max(range.most, picture.at(x, y)[c]);
        }
      }
    }
  }

  bool may_hold(const std::uint8_t* value, int x, int y, int tolerance) const {
    for (int c = 0; c < channels_; ++c) {
      int least = 255, most = 0;
      for (int ty = std::max(0, y / side_ - 1); ty <= std::min(rows_ - 1, y / side_ + 1); ++ty) {
        for (int tx = std::max(0, x / side_ - 1); tx <= std::min(columns_ - 1, x / side_ + 1);
             ++tx) {
          least = std::min<int>(least, ranges_[index(tx, ty, c)].least);
          most = std::max<int>(most, ranges_[index(tx, ty, c)].most);
        }
      }
      if (value[c] + tolerance < least || value[c] - tolerance > most) return false;
    }
    return true;
  }

 private:
  struct Range {
    std::uint8_t least, most;
  };
  std::size_t index(int tx, int ty, int c) const {
    return (std::size_t(ty) * columns_ + tx) * channels_ + c;
  }

  int side_, channels_, columns_, rows_;
  std::vector<Range> ranges_;
};

class Finder {
 public:
  Finder(const Image& picture, const DisplacementOptions& options, std::span<const Offset> offsets)
      : picture_(picture),
        options_(options),
        offsets_(offsets),
        ranges_(picture, options.radius + 1) {}

  /// From (x, y) to the nearest place that has `value`; infinite beyond the radius.
  double distance(const std::uint8_t* value, int x, int y) const {
    double best = kInfinity;
    if (!ranges_.may_hold(value, x, y, options_.tolerance)) return best;
    for (const Offset& offset : offsets_) {
      // A line between two centres comes at most one pixel nearer than its farther end.
      if (offset.distance - 1.0 >= best) break;
      if (!is_inside(x + offset.x, y + offset.y)) continue;
      for (const auto& step : kSteps)
        best = std::min(best, along(value, x, y, offset, step[0], step[1]));
    }
    return best <= options_.radius ? best : kInfinity;
  }

 private:
  /// Each line between neighbours once, from its left or upper end.
  static constexpr int kSteps[][2] = {{1, 0}, {0, 1}};

  bool is_inside(int x, int y) const {
    return x >= 0 && y >= 0 && x < picture_.width && y < picture_.height;
  }

  /// The same to the nearest place on the line from the pixel at the offset to that beside it.
  double along(const std::uint8_t* value, int x, int y, const Offset& offset, int dx,
               int dy) const {
    const int qx = x + offset.x, qy = y + offset.y;
    const bool has_neighbour = is_inside(qx + dx, qy + dy);
    const std::uint8_t* a = picture_.at(qx, qy);
    const std::uint8_t* b = has_neighbour ? picture_.at(qx + dx, qy + dy) : a;
    double low = 0.0, high = has_neighbour ? 1.0 : 0.0;
    for (int c = 0; c < picture_.channels; ++c) {
      const double slope = b[c] - a[c], least = value[c] - options_.tolerance - a[c],
                   most = value[c] + options_.tolerance - a[c];
      if (slope == 0.0) {
        if (least > 0.0 || most < 0.0) return kInfinity;
        continue;
      }
      low = std::max(low, std::min(least / slope, most / slope));
      high = std::min(high, std::max(least / slope, most / slope));
    }
    if (low > high) return kInfinity;
    const double nearest = std::clamp(-1.0 * (offset.x * dx + offset.y * dy), low, high);
    return std::hypot(offset.x + nearest * dx, offset.y + nearest * dy);
  }

  const Image& picture_;
  const DisplacementOptions& options_;
  std::span<const Offset> offsets_;
  TileRanges ranges_;
};

/// Groups of pixels that grow as pixels are added.
class Groups {
 public:
  Groups(int width, int height)
      : width_(width), height_(height), parents_(std::size_t(width) * height, kAbsent) {}

  /// Adds a pixel and joins it to its neighbours; returns how many its group has then.
  std::size_t add(std::size_t pixel) {
    parents_[pixel] = -1;
    const int x = static_cast<int>(pixel % width_), y = static_cast<int>(pixel / width_);
    for (int qy = std::max(0, y - 1); qy <= std::min(height_ - 1, y + 1); ++qy) {
      for (int qx = std::max(0, x - 1); qx <= std::min(width_ - 1, x + 1); ++qx) {
        const std::size_t other = std::size_t(qy) * width_ + qx;
        if (parents_[other] != kAbsent) join(pixel, other);
      }
    }
    return static_cast<std::size_t>(-parents_[root(pixel)]);
  }

 private:
  static constexpr std::int64_t kAbsent = std::numeric_limits<std::int64_t>::max();

  std::size_t root(std::size_t pixel) {
    while (parents_[pixel] >= 0) {
      const auto above = static_cast<std::size_t>(parents_[pixel]);
      if (parents_[above] >= 0) parents_[pixel] = parents_[above];
      pixel = above;
    }
    return pixel;
  }

  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    if (parents_[a] > parents_[b]) std::swap(a, b);
    parents_[a] += parents_[b];
    parents_[b] = static_cast<std::int64_t>(a);
  }

  int width_, height_;
  /// Of a pixel that was added: the one above it in its group, or less its group's size.
  std::vector<std::int64_t> parents_;
};

struct Failing {
  std::size_t pixel = 0;
  double distance = 0.0;
};

bool differ(const std::uint8_t* a, const std::uint8_t* b, int channels, int tolerance) {
  for (int c = 0; c < channels; ++c)
    if (std::abs(a[c] - b[c]) > tolerance) return true;
  return false;
}

}  // namespace

Displacement displacement(const Image& reference, const Image& test,
                          const DisplacementOptions& options) {
  raster::require(reference.width == test.width && reference.height == test.height &&
                      reference.channels == test.channels,
                  "a displacement is of pictures of one size");
  raster::require(options.radius >= 1 && options.radius <= 64, "radius is 1 to 64 pixels");
  const std::vector<Offset> offsets = offsets_within(options.radius + 1);
  const Finder in_reference(reference, options, offsets), in_test(test, options, offsets);
  std::vector<Failing> failing;
  for (int y = 0; y < test.height; ++y) {
    for (int x = 0; x < test.width; ++x) {
      const std::uint8_t *wanted = reference.at(x, y), *got = test.at(x, y);
      if (!differ(wanted, got, test.channels, options.tolerance)) continue;
      failing.push_back(
          {std::size_t(y) * test.width + x,
           std::max(in_reference.distance(got, x, y), in_test.distance(wanted, x, y))});
    }
  }
  std::stable_sort(failing.begin(), failing.end(),
                   [](const Failing& a, const Failing& b) { return a.distance > b.distance; });
  Displacement result{.px = 0.0, .differing = failing.size(), .passed_over = 0};
  Groups groups(test.width, test.height);
  for (const Failing& pixel : failing) {
    if (groups.add(pixel.pixel) > options.speck) {
      result.px = pixel.distance;
      break;
    }
    ++result.passed_over;
  }
  return result;
}

}  // namespace gnomon::ar
