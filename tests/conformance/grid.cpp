#include "grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <utility>

#include "raster/execute.h"
#include "raster/variants.h"

namespace gnomon::conformance {

namespace {

/// A grid that is wrong everywhere says so this often.
constexpr int kReportsPerGrid = 5;
/// A batch ends with so many cases or pixels, whichever comes first.
constexpr std::size_t kCasesPerBatch = 100, kPixelsPerBatch = std::size_t{1} << 18;

double now_s() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

struct Difference {
  std::uint64_t bytes = 0;
  std::string first = {};
};

std::string hex(const std::uint8_t* bytes, std::size_t count) {
  std::string text;
  char two[3];
  for (std::size_t i = 0; i < count; ++i) {
    std::snprintf(two, sizeof two, "%02x", bytes[i]);
    text += two;
  }
  return text;
}

template <class T>
bool same_storage(const raster::TiledPlane<T>& a, const raster::TiledPlane<T>& b) {
  for (int y = 0; y < a.tiles_y(); ++y)
    for (int x = 0; x < a.tiles_x(); ++x)
      if (std::memcmp(a.tile(x, y), b.tile(x, y), sizeof(T) * raster::kPixelsPerTile) != 0)
        return false;
  return true;
}

template <class T>
void compare_planes(const char* what, std::size_t set, const raster::TiledPlane<T>& got,
                    const raster::TiledPlane<T>& expected, Difference& difference) {
  if (same_storage(got, expected)) return;
  for (int y = 0; y < got.height(); ++y)
    for (int x = 0; x < got.width(); ++x) {
      std::uint8_t a[sizeof(T)], b[sizeof(T)];
      std::memcpy(a, &got.at(x, y), sizeof(T));
      std::memcpy(b, &expected.at(x, y), sizeof(T));
      if (std::memcmp(a, b, sizeof(T)) == 0) continue;
      if (difference.bytes == 0)
        difference.first = std::string(what) + " of target " + std::to_string(set) + " at (" +
                           std::to_string(x) + ", " + std::to_string(y) + ") is " +
                           hex(a, sizeof(T)) + ", not " + hex(b, sizeof(T));
      for (std::size_t i = 0; i < sizeof(T); ++i) difference.bytes += a[i] != b[i];
    }
}

Difference compare(const std::vector<Buffers>& got, const std::vector<Buffers>& expected) {
  Difference difference;
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (got[i].color.format() == raster::ColorFormat::rgba8)
      compare_planes("colour", i, got[i].color.rgba8(), expected[i].color.rgba8(), difference);
    else
      compare_planes("colour", i, got[i].color.rgba32f(), expected[i].color.rgba32f(), difference);
    compare_planes("depth", i, got[i].depth.plane(), expected[i].depth.plane(), difference);
    compare_planes("stencil", i, got[i].stencil.plane(), expected[i].stencil.plane(), difference);
  }
  return difference;
}

std::uint64_t pixels_of(const std::vector<Buffers>& sets) {
  std::uint64_t pixels = 0;
  for (const Buffers& b : sets) pixels += static_cast<std::uint64_t>(b.width()) * b.height();
  return pixels;
}

}  // namespace

/// Prints what the grids of this run add up to.
class Report : public ::testing::Environment {
 public:
  static Report& only() {
    // GoogleTest owns and deletes it.
    static Report* const kReport =
        static_cast<Report*>(::testing::AddGlobalTestEnvironment(new Report));
    return *kReport;
  }

  void add(const Grid& grid, double seconds) {
    rows_.push_back({grid.name_, grid.cases_, grid.pixels_, grid.runs_, grid.compared_,
                     grid.differing_bytes_, seconds});
  }
  void TearDown() override {
    if (rows_.empty()) return;
    std::printf("\n%-44s %7s %10s %8s %12s %6s\n", "grid", "cases", "pixels", "runs", "compared",
                "s");
    Row sum{.name = "all"};
    for (const Row& row : rows_) {
      print(row);
      sum.cases += row.cases;
      sum.pixels += row.pixels;
      sum.runs += row.runs;
      sum.compared += row.compared;
      sum.differing_bytes += row.differing_bytes;
      sum.seconds += row.seconds;
    }
    print(sum);
    std::string isas;
    for (const raster::Isa isa : raster::available_isas()) {
      if (!isas.empty()) isas += ", ";
      isas += raster::name(isa);
    }
    std::printf("conformance: %llu cases, %llu pixels, %llu runs (%s; 1, 2, 3, 7, 16 threads), ",
                number(sum.cases), number(sum.pixels), number(sum.runs), isas.c_str());
    std::printf("%llu pixels compared, %llu differing bytes\n", number(sum.compared),
                number(sum.differing_bytes));
  }

 private:
  struct Row {
    std::string name;
    std::uint64_t cases = 0, pixels = 0, runs = 0, compared = 0, differing_bytes = 0;
    double seconds = 0.0;
  };
  static unsigned long long number(std::uint64_t n) { return n; }
  static void print(const Row& row) {
    std::printf("%-44s %7llu %10llu %8llu %12llu %6.2f\n", row.name.c_str(), number(row.cases),
                number(row.pixels), number(row.runs), number(row.compared), row.seconds);
  }

  std::vector<Row> rows_;
};

namespace {

// Registered before main runs any test.
const Report& registered_report = Report::only();

}  // namespace

Grid::Grid(std::string name) : name_(std::move(name)), started_s_(now_s()) {
  (void)registered_report;
}

Grid::~Grid() {
  for (auto& [key, batch] : batches_) run(batch, std::get<Runs>(key));
  Report::only().add(*this, now_s() - started_s_);
}

void Grid::count(std::uint64_t pixels, std::uint64_t runs, std::uint64_t differing_bytes) {
  ++cases_;
  pixels_ += pixels;
  runs_ += runs;
  compared_ += pixels * runs;
  differing_bytes_ += differing_bytes;
}

Expected Grid::check(const std::string& name, const std::vector<Buffers>& initial,
                     const Record& record, Runs runs) {
  Expected expected{initial, {}};
  raster::Frame slow;
  record(slow, expected.buffers);
  expected.outcomes = reference::execute(slow);

  Batch& batch = batches_[{runs, initial.front().width(), initial.front().height()}];
  batch.cases.push_back({name, initial, initial, expected.buffers});
  record(batch.frame, batch.cases.back().got);
  batch.pixels += pixels_of(initial);
  if (batch.cases.size() >= kCasesPerBatch || batch.pixels >= kPixelsPerBatch) run(batch, runs);
  return expected;
}

void Grid::run(Batch& batch, Runs runs) {
  static std::size_t batches = 0;
  if (batch.cases.empty()) return;
  const auto variants = runs == Runs::every_variant
                            ? variants::every_variant()
                            : variants::every_isa(variants::kThreads[batches++ % 5]);
  std::vector<std::uint64_t> differing(batch.cases.size());
  for (const raster::ExecuteOptions& options : variants) {
    // In place: the frame borrows the buffers.
    for (Case& c : batch.cases) std::copy(c.initial.begin(), c.initial.end(), c.got.begin());
    raster::execute(batch.frame, options);
    for (std::size_t i = 0; i < batch.cases.size(); ++i) {
      const Case& c = batch.cases[i];
      const Difference difference = compare(c.got, c.expected);
      differing[i] += difference.bytes;
      if (difference.bytes != 0 && reported_++ < kReportsPerGrid)
        ADD_FAILURE() << name_ << ", case \"" << c.name << "\", " << variants::name(options) << ": "
                      << difference.first << "; " << difference.bytes << " bytes differ";
    }
  }
  for (std::size_t i = 0; i < batch.cases.size(); ++i)
    count(pixels_of(batch.cases[i].initial), variants.size(), differing[i]);
  batch = {};
}

Expected Grid::check(const std::string& name, const Buffers& initial, const RecordPass& record,
                     Runs runs) {
  return check(
      name, std::vector<Buffers>{initial},
      [&](raster::Frame& frame, std::vector<Buffers>& sets) {
        frame.begin_pass(name, sets.front().all());
        record(frame, sets.front());
      },
      runs);
}

}  // namespace gnomon::conformance
