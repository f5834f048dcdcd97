#include <algorithm>
#include <map>
#include <optional>
#include <thread>

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

/// The calling thread's arena of so many threads: one that is kept has its workers at hand.
tbb::task_arena& arena_of(int threads) {
  thread_local std::map<int, tbb::task_arena> arenas;
  return arenas.try_emplace(threads, threads).first->second;
}

}  // namespace

int machine_threads() { return tbb::info::default_concurrency(); }

void run_on_threads(int count, const std::function<void(int number)>& worker) {
  // The scheduler keeps no more workers than the machine has unless it is told to.
  std::optional<tbb::global_control> more_workers;
  if (count > machine_threads())
    more_workers.emplace(tbb::global_control::max_allowed_parallelism,
                         static_cast<std::size_t>(count));
  OrderedPoint fork, join;
  fork.release();
  tbb::task_arena& arena = arena_of(count);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>&) {
          fork.acquire();
          // A place in the arena belongs to a thread as long as it stays.
          worker(std::clamp(tbb::this_task_arena::current_thread_index(), 0, count - 1));
          join.release();
        },
        tbb::simple_partitioner());
  });
  join.acquire();
}

void yield_thread() { std::this_thread::yield(); }

}  // namespace gnomon::raster
