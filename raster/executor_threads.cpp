// The executor on the C++ library's own threads, started for each call: for machines without
// oneTBB, and for emulators and checkers of threads that cannot follow it.
#include <thread>
#include <vector>

#include "raster/executor.h"

namespace gnomon::raster {

void run_on_threads(int threads, const std::function<void()>& worker) {
  const unsigned wanted =
      threads > 0 ? static_cast<unsigned>(threads) : std::thread::hardware_concurrency();
  std::vector<std::jthread> helpers;
  for (unsigned i = 1; i < wanted; ++i) helpers.emplace_back(worker);
  worker();
}

}  // namespace gnomon::raster
