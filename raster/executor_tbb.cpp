#include <optional>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "raster/executor.h"

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

void run_on_threads(int threads, const std::function<void()>& worker) {
  const int wanted = threads > 0 ? threads : tbb::info::default_concurrency();
  // The scheduler keeps no more workers than the machine has unless it is told to.
  std::optional<tbb::global_control> more_workers;
  if (wanted > tbb::info::default_concurrency())
    more_workers.emplace(tbb::global_control::max_allowed_parallelism,
                         static_cast<std::size_t>(wanted));
  OrderedPoint fork, join;
  fork.release();
  tbb::task_arena arena(wanted);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, wanted, 1),
        [&](const tbb::blocked_range<int>&) {
          fork.acquire();
          worker();
          join.release();
        },
        tbb::simple_partitioner());
  });
  join.acquire();
}

}  // namespace gnomon::raster
