// The executor for machines without threads: everything on the calling thread.
#include "raster/executor.h"

namespace gnomon::raster {

int machine_threads() { return 1; }

void yield_thread() {}

void run_on_threads(int /*count*/, const std::function<void(int number)>& worker) { worker(0); }

}  // namespace gnomon::raster
