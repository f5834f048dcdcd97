// The one place that knows threads. Work is cut in chunks of a fixed size, never count / threads,
// so the cut does not depend on how many threads there are.
#pragma once

#include <cstddef>
#include <functional>

namespace gnomon::raster {

/// Calls body(first, last) for consecutive chunks of [0, count), in any order, on up to `threads`
/// threads (0: the machine's). With threads = 1 everything runs on the calling thread, in order,
/// and no scheduler is touched. An exception of a body reaches the caller.
void for_each_chunk(std::size_t count, std::size_t chunk, int threads,
                    const std::function<void(std::size_t first, std::size_t last)>& body);

}  // namespace gnomon::raster
