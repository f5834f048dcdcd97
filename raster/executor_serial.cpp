// The executor for machines without threads: every chunk on the calling thread, in order.
#include <algorithm>

#include "raster/executor.h"

namespace gnomon::raster {

void for_each_chunk(std::size_t count, std::size_t chunk, int /*threads*/,
                    const std::function<void(std::size_t first, std::size_t last)>& body) {
  for (std::size_t first = 0; first < count; first += chunk)
    body(first, std::min(count, first + chunk));
}

}  // namespace gnomon::raster
