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

/// Runs the phases, at most three, one after the other, the pieces of each in any order, on up to
/// `threads` threads (0: the machine's). With threads = 1 everything runs on the calling thread, in
/// order, and no scheduler is touched. An exception of a piece reaches the caller; pieces not begun
/// are left out. Threads are asked for once, not once a phase: a late one finds its work where it
/// is. Each begins with a share of the pieces that is its own in every call, so that what it wrote
/// the last time is still in its core's cache, and then helps with the others'.
void run_phases(std::span<const Phase> phases, int threads);

/// Calls body(first, last) for consecutive chunks of [0, count), in any order.
/// Precondition: chunk is positive.
void for_each_chunk(std::size_t count, std::size_t chunk, int threads,
                    const std::function<void(std::size_t first, std::size_t last)>& body);

// What an executor (oneTBB, C++ threads, serial) has to give:

/// How many threads the machine runs at a time.
int machine_threads();
/// Calls worker(number) up to `count` times, on the calling thread and, at the same time or later
/// or not at all, on others; returns when all calls have. `number`, from 0 to count - 1, is the
/// same for a thread in one call and the next wherever the executor can have it so. Preconditions:
/// count is positive; worker does not throw and is right however many of its calls are made, and
/// with whatever numbers.
void run_on_threads(int count, const std::function<void(int number)>& worker);
/// Lets others run that the calling thread waits for.
void yield_thread();

}  // namespace gnomon::raster
