#include "raster/executor.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace gnomon::raster {

namespace {

/// Pieces of one phase as threads take and finish them.
struct Progress {
  std::atomic<std::size_t> next{0}, finished{0};
};

/// The phases on their way; every thread that helps calls work().
class Run {
 public:
  explicit Run(std::span<const Phase> phases) : phases_(phases), progress_(phases.size()) {}

  void work() {
    for (std::size_t p = 0; p < phases_.size(); ++p) {
      take_pieces(phases_[p], progress_[p]);
      // What the others still have in hand is at most one piece each.
      while (progress_[p].finished.load(std::memory_order_acquire) < phases_[p].count) {
        if (failed_.load(std::memory_order_acquire)) return;
        std::this_thread::yield();
      }
    }
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void take_pieces(const Phase& phase, Progress& progress) {
    for (std::size_t i = progress.next++; i < phase.count; i = progress.next++) {
      if (failed_.load(std::memory_order_relaxed)) return;
      try {
        phase.run(i);
      } catch (...) {
        const std::lock_guard lock(failure_lock_);
        if (!failure_) failure_ = std::current_exception();
        failed_.store(true, std::memory_order_release);
        return;
      }
      progress.finished.fetch_add(1, std::memory_order_acq_rel);
    }
  }

  std::span<const Phase> phases_;
  std::vector<Progress> progress_;
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::mutex failure_lock_;
};

}  // namespace

void run_phases(std::span<const Phase> phases, int threads) {
  std::size_t most = 0;
  for (const Phase& phase : phases) most = std::max(most, phase.count);
  if (threads == 1 || most <= 1) {
    for (const Phase& phase : phases)
      for (std::size_t i = 0; i < phase.count; ++i) phase.run(i);
    return;
  }
  Run run(phases);
  run_on_threads(threads, [&run] { run.work(); });
  run.rethrow();
}

void for_each_chunk(std::size_t count, std::size_t chunk, int threads,
                    const std::function<void(std::size_t first, std::size_t last)>& body) {
  const Phase phase{(count + chunk - 1) / chunk,
                    [&](std::size_t i) { body(i * chunk, std::min(count, (i + 1) * chunk)); }};
  run_phases({&phase, 1}, threads);
}

}  // namespace gnomon::raster
