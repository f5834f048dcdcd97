// The one place that knows threads. Work is cut in pieces that do not depend on how many threads
// there are; which thread runs a piece, and when, has no part in what it does.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace gnomon::raster {

/// Independent pieces of work, numbered from 0.
struct Phase {
  std::size_t count = 0;
  std::function<void(std::size_t piece)> run;
};

/// Runs the phases one after the other, the pieces of each in any order, on up to `threads` threads
/// (0: the machine's). With threads = 1 everything runs on the calling thread, in order, and no
/// scheduler is touched. An exception of a piece reaches the caller; pieces not begun are left out.
/// Threads are asked for once, not once a phase: a late one finds its work where it is.
void run_phases(std::span<const Phase> phases, int threads);

/// Calls body(first, last) for consecutive chunks of [0, count), in any order.
void for_each_chunk(std::size_t count, std::size_t chunk, int threads,
                    const std::function<void(std::size_t first, std::size_t last)>& body);

/// What an executor (oneTBB, C++ threads, serial) has to give: calls worker() on the calling thread
/// and, at the same time or later or not at all, on up to threads - 1 others; returns when all
/// calls have. Precondition: worker() does not throw and is right however many run.
void run_on_threads(int threads, const std::function<void()>& worker);

}  // namespace gnomon::raster
