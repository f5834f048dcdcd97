#include "ar/pixel_footprints.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::ar {
namespace {

/// Where a cell's ray ended, besides patch numbers.
constexpr std::uint32_t kNoRay = 0xffffffffu, kOpen = 0xfffffffeu, kBack = 0xfffffffdu;
/// A pixel that shows less of the model than this says nothing sure about it.
constexpr double kLeastShare = 0.5;

struct Cell {
  std::uint32_t patch = kNoRay;
  float solid_angle_sr = 0.0f;
};

/// Of the triangle that three unit vectors span (Van Oosterom and Strackee 1983).
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
  return 2.0 * std::atan2(volume, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

class Cells {
 public:
  Cells(const FootprintWindow& window, int samples)
      : window_(window),
        samples_(samples),
        columns_((window.x1 - window.x0) * samples),
        rows_((window.y1 - window.y0) * samples),
        cells_(static_cast<std::size_t>(columns_) * rows_) {}

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const Cell& at(int column, int row) const {
    return cells_[static_cast<std::size_t>(row) * columns_ + column];
  }

  /// Rows next to each other share their corners.
  void trace_rows(int first, int last, const RayOfPlace& ray_of,
                  const pipeline::PatchVisibility& patches) {
    Corners top = corners(first, ray_of);
    for (int row = first; row < last; ++row) {
      Corners bottom = corners(row + 1, ray_of);
      trace_row(row, top, bottom, patches);
      top = std::move(bottom);
    }
  }

 private:
  using Corners = std::vector<std::optional<Ray>>;

  void trace_row(int row, const Corners& top, const Corners& bottom,
                 const pipeline::PatchVisibility& patches) {
    for (int x = 0; x < columns_; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const auto &a = top[i], &b = top[i + 1], &c = bottom[i + 1], &d = bottom[i];
      if (!a || !b || !c || !d) continue;
      Cell& cell = cells_[static_cast<std::size_t>(row) * columns_ + i];
      cell.solid_angle_sr =
          static_cast<float>(solid_angle(a->direction, b->direction, c->direction) +
                             solid_angle(a->direction, c->direction, d->direction));
      const pipeline::PatchVisibility::Hit hit =
          patches.trace((a->origin + b->origin + c->origin + d->origin) * 0.25,
                        glm::normalize(a->direction + b->direction + c->direction + d->direction));
      cell.patch = hit.patch == pipeline::PatchVisibility::kNone ? kOpen
                   : hit.front ? static_cast<std::uint32_t>(hit.patch)
                               : kBack;
    }
  }

  glm::dvec2 place(double column, double row) const {
    return {window_.x0 - 0.5 + column / samples_, window_.y0 - 0.5 + row / samples_};
  }
  Corners corners(int row, const RayOfPlace& ray_of) const {
    Corners line;
    for (int x = 0; x <= columns_; ++x) line.push_back(ray_of(place(x, row)));
    return line;
  }

  FootprintWindow window_;
  int samples_, columns_, rows_;
  std::vector<Cell> cells_;
};

/// One pixel's shares, from the cells less than a pixel away.
class Gatherer {
 public:
  explicit Gatherer(std::size_t patches) : share_of_(patches, 0.0) {}

  /// False if the pixel is not usable.
  bool gather(const Cells& cells, int x, int y, int samples) {
    for (const std::uint32_t patch : touched_) share_of_[patch] = 0.0;
    touched_.clear();
    total_ = on_model_ = 0.0;
    // The tent reaches one pixel from the pixel's centre: half a pixel over each edge.
    const int reach = (samples + 1) / 2;
    for (int row = y * samples - reach; row < (y + 1) * samples + reach; ++row) {
      for (int column = x * samples - reach; column < (x + 1) * samples + reach; ++column) {
        if (!add(cells, column, row, x, y, samples)) return false;
      }
    }
    return on_model_ > kLeastShare * total_;
  }

  double solid_angle_sr() const { return total_; }
  void append_to(std::vector<PatchShare>& shares) const {
    for (const std::uint32_t patch : touched_)
      shares.push_back({patch, static_cast<float>(share_of_[patch] / on_model_)});
  }

 private:
  bool add(const Cells& cells, int column, int row, int x, int y, int samples) {
    const auto tent = [samples](int cell, int pixel) {
      return 1.0 - std::abs((cell + 0.5) / samples - (pixel + 0.5));
    };
    const double weight = tent(column, x) * tent(row, y);
    if (!(weight > 0.0)) return true;
    if (column < 0 || row < 0 || column >= cells.columns() || row >= cells.rows()) return false;
    const Cell& cell = cells.at(column, row);
    if (cell.patch == kNoRay) return false;
    const double part = weight * static_cast<double>(cell.solid_angle_sr);
    total_ += part;
    if (cell.patch >= kBack) return true;
    on_model_ += part;
    if (share_of_[cell.patch] == 0.0) touched_.push_back(cell.patch);
    share_of_[cell.patch] += part;
    return true;
  }

  std::vector<double> share_of_;
  std::vector<std::uint32_t> touched_;
  double total_ = 0.0, on_model_ = 0.0;
};

void append(PixelFootprints& all, const PixelFootprints& row) {
  for (std::size_t i = 0; i < row.size(); ++i)
    all.first.push_back(all.shares.size() + row.first[i + 1]);
  all.shares.insert(all.shares.end(), row.shares.begin(), row.shares.end());
  all.radiance.insert(all.radiance.end(), row.radiance.begin(), row.radiance.end());
  all.solid_angle_sr.insert(all.solid_angle_sr.end(), row.solid_angle_sr.begin(),
                            row.solid_angle_sr.end());
}

}  // namespace

PixelFootprints find_footprints(const FloatImage& radiance, const FootprintWindow& window,
                                const RayOfPlace& ray_of, const pipeline::PatchVisibility& patches,
                                const pipeline::PatchModel& model,
                                const FootprintOptions& options) {
  raster::require(options.samples >= 1 && options.samples <= 16,
                  "a pixel has 1 to 16 samples a side");
  raster::require(window.x0 >= 0 && window.y0 >= 0 && window.x0 <= window.x1 &&
                      window.y0 <= window.y1 && window.x1 <= radiance.width &&
                      window.y1 <= radiance.height,
                  "the window lies in the picture");
  const int width = window.x1 - window.x0, height = window.y1 - window.y0;
  Cells cells(window, options.samples);
  raster::for_each_chunk(static_cast<std::size_t>(cells.rows()), 16, options.threads,
                         [&](std::size_t first, std::size_t last) {
                           cells.trace_rows(static_cast<int>(first), static_cast<int>(last), ray_of,
                                            patches);
                         });
  std::vector<PixelFootprints> rows(static_cast<std::size_t>(height));
  raster::for_each_chunk(rows.size(), 8, options.threads, [&](std::size_t first, std::size_t last) {
    Gatherer gatherer(model.patches.size());
    for (std::size_t y = first; y < last; ++y) {
      for (int x = 0; x < width; ++x) {
        if (!gatherer.gather(cells, x, static_cast<int>(y), options.samples)) continue;
        const float* value = radiance.at(window.x0 + x, window.y0 + static_cast<int>(y));
        gatherer.append_to(rows[y].shares);
        rows[y].first.push_back(rows[y].shares.size());
        rows[y].radiance.emplace_back(value[0], value[1], value[2]);
        rows[y].solid_angle_sr.push_back(gatherer.solid_angle_sr());
      }
    }
  });
  PixelFootprints all;
  for (const PixelFootprints& row : rows) append(all, row);
  for (int y = 0; y < cells.rows(); ++y) {
    for (int x = 0; x < cells.columns(); ++x) {
      const Cell& cell = cells.at(x, y);
      const auto part = static_cast<double>(cell.solid_angle_sr);
      all.total_sr += part;
      all.open_sr += cell.patch == kOpen ? part : 0.0;
      all.back_sr += cell.patch == kBack ? part : 0.0;
    }
  }
  return all;
}

}  // namespace gnomon::ar
