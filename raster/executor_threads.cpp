// The executor on the C++ library's own threads, started for each call: for machines without
// oneTBB, and for emulators and checkers of threads that cannot follow it.
#include <algorithm>
#include <system_error>
#include <thread>
#include <vector>

#include "raster/executor.h"

namespace gnomon::raster {

int machine_threads() {
  return static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
}

void run_on_threads(int count, const std::function<void(int number)>& worker) {
  std::vector<std::jthread> helpers;
  try {
    for (int i = 1; i < count; ++i) helpers.emplace_back(worker, i);
  } catch (const std::system_error&) {
    // The machine has no more threads; those that are there do the work.
  }
  worker(0);
}

void yield_thread() { std::this_thread::yield(); }

}  // namespace gnomon::raster
