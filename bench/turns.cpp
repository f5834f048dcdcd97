#include "bench/turns.h"

#include "ar/stopwatch.h"
#include "bench/statistics.h"

namespace gnomon::bench {
namespace {

constexpr int kFewestFrames = 3;
constexpr double kShort_ms = 50.0;

}  // namespace

void Series::append(const Series& other) {
  for (std::size_t stage = 0; stage < times.size(); ++stage) {
    times[stage].insert(times[stage].end(), other.times[stage].begin(), other.times[stage].end());
  }
  frames += other.frames;
}

StageTimes Series::medians() const {
  StageTimes out;
  for (std::size_t stage = 0; stage < times.size(); ++stage) {
    if (!times[stage].empty()) out[stage] = median(times[stage]);
  }
  return out;
}

std::vector<Series> take_turns(const std::vector<std::unique_ptr<Worker>>& workers,
                               const TurnOptions& options) {
  std::vector<Series> all(workers.size());
  std::vector<double> spent_s(workers.size());
  std::vector<StageTimes> last(workers.size());
  for (std::size_t i = 0; i < workers.size(); ++i) last[i] = workers[i]->frame();
  for (int turn = 0; turn < options.frames; ++turn) {
    for (std::size_t i = 0; i < workers.size(); ++i) {
      if (spent_s[i] > options.cap_s && all[i].frames >= kFewestFrames) continue;
      ar::Stopwatch timer;
      if (at(last[i], Stage::frame).value_or(0.0) < kShort_ms) workers[i]->frame();
      last[i] = workers[i]->frame();
      spent_s[i] += timer.lap_ms() / 1000.0;
      ++all[i].frames;
      for (std::size_t stage = 0; stage < last[i].size(); ++stage) {
        if (last[i][stage]) all[i].times[stage].push_back(*last[i][stage]);
      }
    }
  }
  return all;
}

}  // namespace gnomon::bench
