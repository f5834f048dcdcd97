// The executor for machines without threads: everything on the calling thread.
#include "raster/executor.h"

namespace gnomon::raster {

void run_on_threads(int /*threads*/, const std::function<void()>& worker) { worker(); }

}  // namespace gnomon::raster
