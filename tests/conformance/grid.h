// A grid of conformance cases: each case records a frame; the slow exact reference runs it once,
// raster/ runs it in several variants (tests/raster/variants.h), and every byte of every buffer
// must be the same. Nothing is tolerated and nothing is skipped. The totals of all grids of a run
// are printed at its end; docs/conformance.md quotes them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "raster/frame.h"
#include "reference/reference.h"

namespace gnomon::conformance {

struct Size {
  int width = 0, height = 0;
};

/// One pixel, less than a block, a tile with an edge that is no block's, several tiles.
inline constexpr Size kSizes[]{{1, 1}, {7, 5}, {63, 65}, {130, 70}};

/// One set of targets with their contents.
struct Buffers {
  raster::ColorBuffer color;
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;

  explicit Buffers(Size size, raster::DepthFormat depth_format = raster::DepthFormat::d24,
                   raster::ColorFormat color_format = raster::ColorFormat::rgba8)
      : color(size.width, size.height, color_format),
        depth(size.width, size.height, depth_format),
        stencil(size.width, size.height) {}

  raster::Targets all() { return {&color, &depth, &stencil}; }
  int width() const { return color.width(); }
  int height() const { return color.height(); }
};

/// Records a case for these targets. It is called twice, for the reference and for the variants,
/// and must record the same both times.
using Record = std::function<void(raster::Frame&, std::vector<Buffers>&)>;
/// The same where there is one set of targets: they are one pass's, which has begun.
using RecordPass = std::function<void(raster::Frame&, Buffers&)>;

/// each_isa: every instruction set, on a number of threads that changes from batch to batch;
/// every_variant: every instruction set on every number of threads.
enum class Runs { each_isa, every_variant };

/// What the reference left, for expectations beyond the bytes.
struct Expected {
  std::vector<Buffers> buffers;
  reference::Outcomes outcomes;

  const Buffers& only() const { return buffers.front(); }
};

/// The reference runs a case at once. The variants run batches of cases, each case a pass of one
/// frame, because starting threads takes longer than most cases do.
class Grid {
 public:
  /// `name` as in the printed table.
  explicit Grid(std::string name);
  ~Grid();
  Grid(const Grid&) = delete;
  Grid& operator=(const Grid&) = delete;

  /// Fails the running test, at the latest when the grid ends, where a variant leaves another byte
  /// than the reference.
  Expected check(const std::string& name, const std::vector<Buffers>& initial, const Record& record,
                 Runs runs = Runs::each_isa);
  Expected check(const std::string& name, const Buffers& initial, const RecordPass& record,
                 Runs runs = Runs::each_isa);

  /// Counts a case that a test compares itself, over so many values and runs.
  void count(std::uint64_t pixels, std::uint64_t runs, std::uint64_t differing_bytes);

 private:
  friend class Report;
  struct Case {
    std::string name;
    std::vector<Buffers> initial, got, expected;
  };
  struct Batch {
    raster::Frame frame;
    std::vector<Case> cases;
    std::uint64_t pixels = 0;
  };
  void run(Batch& batch, Runs runs);

  std::string name_;
  /// By runs and by the first target's size: passes of one size in a row are one group to raster/.
  std::map<std::tuple<Runs, int, int>, Batch> batches_;
  std::uint64_t cases_ = 0, pixels_ = 0, runs_ = 0, compared_ = 0, differing_bytes_ = 0;
  int reported_ = 0;
  double started_s_ = 0.0;
};

}  // namespace gnomon::conformance
