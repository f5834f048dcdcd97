// What a run found: a row a stage, with its ratio to gnomon, as JSON and as tables.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/runner.h"

namespace gnomon::bench {

struct Row {
  std::string scene;
  Size size;
  int threads = 1;
  Method method = Method::automatic;
  Stage stage = Stage::frame;
  System system = System::gnomon;
  double median_ms = 0.0;
  /// median_ms by gnomon's of the same scene, size, threads and stage: of the same method, or of
  /// auto for rays. Absent where gnomon has no such row.
  std::optional<double> ratio_to_gnomon;
};

/// How two pictures of one scene and size agree.
struct Agreement {
  std::string scene;
  Size size;
  System system = System::llvmpipe;
  Method method = Method::zfail;
  int threads = 1;
  /// Pixels that are in shadow in one picture only (of depth or a layer: that hold another value).
  std::size_t differing = 0, pixels = 0;
  /// Parts of the picture in shadow (nearer than the far plane; counted).
  double gnomon_share = 0.0, share = 0.0;
};

struct Report {
  std::string date, processor, commit;
  /// One-minute load of the machine at the start.
  double load = 0.0;
  std::vector<Row> rows;
  std::vector<Agreement> agreements;
  /// "tori-12 640x480: color rgba8 640x480 0123456789abcdef".
  std::vector<std::string> hashes;
  /// Series with fewer frames than asked for, in words.
  std::vector<std::string> notes;
};

/// Of one scene, size and number of threads.
bool same_place(const Row& a, const Row& b);

/// The row at the place of another one; null if there is none.
const Row* find(const std::vector<Row>& rows, const Row& place, System system, Method method,
                Stage stage);

/// Adds a row "auto" for a peer that has several methods: those of its faster one, by its whole
/// frame. Then sets every ratio.
void complete(std::vector<Row>& rows);

nlohmann::json to_json(const Report& report);

/// Fixed-width columns for a terminal: a line a system, method and number of threads.
std::string table(const std::vector<Row>& rows);

/// For docs/performance.md: the goals, and whole frames and volumes with the systems side by side.
std::string markdown(const Report& report);

}  // namespace gnomon::bench
