#include "raster/executor.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>

#include "raster/check.h"

namespace gnomon::raster {

namespace {

/// A thread's share of a phase's pieces, on a cache line of its own: who finds his own share done
/// takes from it too.
struct alignas(64) Share {
  std::atomic<std::size_t> next{0};
  std::size_t end = 0;
};

/// Threads beyond these share shares.
constexpr std::size_t kMostShares = 16;
constexpr std::size_t kMostPhases = 3;

/// Pieces of one phase as threads take and finish them.
struct Progress {
  std::array<Share, kMostShares> shares;
  std::atomic<std::size_t> finished{0};

  void begin(std::size_t pieces, std::size_t share_count) {
    for (std::size_t i = 0; i < share_count; ++i) {
      shares[i].next = pieces * i / share_count;
      shares[i].end = pieces * (i + 1) / share_count;
    }
  }
};

/// The phases on their way; every thread that helps calls work().
class Run {
 public:
  Run(std::span<const Phase> phases, std::size_t threads)
      : phases_(phases), share_count_(std::min(threads, kMostShares)) {
    for (std::size_t p = 0; p < phases.size(); ++p)
      progress_[p].begin(phases[p].count, share_count_);
  }

  void work(std::size_t thread) {
    for (std::size_t p = 0; p < phases_.size(); ++p) {
      Progress& progress = progress_[p];
      for (std::size_t i = 0; i < share_count_; ++i)
        take_pieces(phases_[p], progress.shares[(thread + i) % share_count_], progress.finished);
      // What the others still have in hand is at most one piece each.
      while (progress.finished.load(std::memory_order_acquire) < phases_[p].count) {
        if (failed_.load(std::memory_order_acquire)) return;
        yield_thread();
      }
    }
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void take_pieces(const Phase& phase, Share& share, std::atomic<std::size_t>& finished) {
    for (std::size_t i = share.next++; i < share.end; i = share.next++) {
      if (failed_.load(std::memory_order_relaxed)) return;
      try {
        phase.run(i);
      } catch (...) {
        // The first one is kept; whoever started the run looks at it when all have returned.
        if (!failing_.exchange(true)) {
          failure_ = std::current_exception();
          failed_.store(true, std::memory_order_release);
        }
        return;
      }
      finished.fetch_add(1, std::memory_order_acq_rel);
    }
  }

  std::span<const Phase> phases_;
  const std::size_t share_count_;
  std::array<Progress, kMostPhases> progress_;
  std::atomic<bool> failing_{false}, failed_{false};
  std::exception_ptr failure_;
};

}  // namespace

void run_phases(std::span<const Phase> phases, int threads) {
  require(phases.size() <= kMostPhases, "a run has at most three phases");
  require(threads >= 0, "a number of threads is not negative");
  std::size_t most = 0;
  for (const Phase& phase : phases) most = std::max(most, phase.count);
  if (threads == 0) threads = machine_threads();
  if (threads == 1 || most <= 1) {
    for (const Phase& phase : phases)
      for (std::size_t i = 0; i < phase.count; ++i) phase.run(i);
    return;
  }
  Run run(phases, static_cast<std::size_t>(threads));
  run_on_threads(threads, [&run](int number) { run.work(static_cast<std::size_t>(number)); });
  run.rethrow();
}

void for_each_chunk(std::size_t count, std::size_t chunk, int threads,
                    const std::function<void(std::size_t first, std::size_t last)>& body) {
  const Phase phase{(count + chunk - 1) / chunk,
                    [&](std::size_t i) { body(i * chunk, std::min(count, (i + 1) * chunk)); }};
  run_phases({&phase, 1}, threads);
}

}  // namespace gnomon::raster
