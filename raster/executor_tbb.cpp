#include "raster/executor.h"

#include <algorithm>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#ifdef GNOMON_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace gnomon::raster {
namespace {

/// ThreadSanitizer cannot look into oneTBB, so it is told what oneTBB orders: what happens before
/// a point is released happens before what follows where it is acquired.
class OrderedPoint {
 public:
#ifdef GNOMON_THREAD_SANITIZER
  void release() { __tsan_release(this); }
  void acquire() { __tsan_acquire(this); }
#else
  void release() {}
  void acquire() {}
#endif
};

}  // namespace

void for_each_chunk(std::size_t count, std::size_t chunk, int threads,
                    const std::function<void(std::size_t first, std::size_t last)>& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  OrderedPoint fork, join;
  const auto run = [&](std::size_t i) {
    fork.acquire();
    body(i * chunk, std::min(count, (i + 1) * chunk));
    join.release();
  };
  fork.release();
  if (threads == 1 || chunks <= 1) {
    for (std::size_t i = 0; i < chunks; ++i) run(i);
    return;
  }
  // The scheduler keeps no more workers than the machine has unless it is told to.
  std::optional<tbb::global_control> more_workers;
  if (threads > tbb::info::default_concurrency())
    more_workers.emplace(tbb::global_control::max_allowed_parallelism,
                         static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : threads);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) run(i);
        },
        tbb::simple_partitioner());
  });
  join.acquire();
}

}  // namespace gnomon::raster
