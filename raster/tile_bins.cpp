#include "raster/tile_bins.h"

#include <algorithm>
#include <cmath>

namespace gnomon::raster {

namespace {

/// The tiles of a row that an edge does not keep out, from its greatest value in tile (0, 0).
class EdgeInRows {
 public:
  explicit EdgeInRows(const Edge& edge)
      : a_(edge.a),
        greatest_(static_cast<double>(edge.at(128, 128)) +
                  kSpan * (std::max(edge.a, 0) + std::max(edge.b, 0))),
        per_step_x_(-1.0 / (kTile * edge.a)),
        step_y_(kTile * edge.b) {}

  /// Narrows tiles [first, last] of row y.
  void narrow(int y, int& first, int& last) const {
    const double here = greatest_ + step_y_ * y;
    if (a_ == 0) {
      if (here < 0.0) last = first - 1;
      return;
    }
    // A thousandth of a tile is more than all rounding.
    const double root = here * per_step_x_;
    if (a_ > 0 && root - kSlack > first)
      first = root > last ? last + 1 : static_cast<int>(std::ceil(root - kSlack));
    if (a_ < 0 && root + kSlack < last)
      last = root < first - 1 ? first - 1 : static_cast<int>(std::floor(root + kSlack));
  }

 private:
  static constexpr double kTile = kTileSize * 256.0, kSpan = (kTileSize - 1) * 256.0;
  static constexpr double kSlack = 1e-3;
  std::int32_t a_;
  double greatest_, per_step_x_, step_y_;
};

}  // namespace

void TileBins::add(int tile_x, int tile_y, std::uint32_t number) {
  touches_.push_back(
      {static_cast<std::uint32_t>((tile_y - y0_) * width_ + (tile_x - x0_)), number});
}

void TileBins::walk(const SetupTriangle& triangle, std::uint32_t number) {
  const PixelBox box = triangle.box();
  const int x0 = box.x0 / kTileSize, x1 = (box.x1 - 1) / kTileSize;
  const int y0 = box.y0 / kTileSize, y1 = (box.y1 - 1) / kTileSize;
  const EdgeInRows edges[3] = {EdgeInRows(triangle.edge(0)), EdgeInRows(triangle.edge(1)),
                               EdgeInRows(triangle.edge(2))};
  for (int y = y0; y <= y1; ++y) {
    int first = x0, last = x1;
    for (const EdgeInRows& edge : edges) edge.narrow(y, first, last);
    for (int x = first; x <= last; ++x) add(x, y, number);
  }
}

void TileBins::fill(std::span<const SetupTriangle> triangles) {
  PixelBox all{kMaxTargetSize, kMaxTargetSize, 0, 0};
  for (const SetupTriangle& triangle : triangles) {
    const PixelBox box = triangle.box();
    all = {std::min(all.x0, box.x0), std::min(all.y0, box.y0), std::max(all.x1, box.x1),
           std::max(all.y1, box.y1)};
  }
  x0_ = all.x0 / kTileSize;
  y0_ = all.y0 / kTileSize;
  width_ = triangles.empty() ? 0 : (all.x1 - 1) / kTileSize + 1 - x0_;
  height_ = triangles.empty() ? 0 : (all.y1 - 1) / kTileSize + 1 - y0_;

  touches_.clear();
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const PixelBox box = triangles[i].box();
    const int x = box.x0 / kTileSize, y = box.y0 / kTileSize;
    if (x == (box.x1 - 1) / kTileSize && y == (box.y1 - 1) / kTileSize)
      add(x, y, i);
    else
      walk(triangles[i], i);
  }
  starts_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1, 0);
  for (const Touch& touch : touches_) ++starts_[touch.tile];
  std::uint32_t sum = 0;
  for (std::uint32_t& start : starts_) {
    sum += start;
    start = sum;
  }
  // From the last to the first, so that a tile's numbers grow and each start ends where it belongs.
  numbers_.resize(touches_.size());
  for (std::size_t i = touches_.size(); i-- > 0;)
    numbers_[--starts_[touches_[i].tile]] = touches_[i].triangle;
}

}  // namespace gnomon::raster
