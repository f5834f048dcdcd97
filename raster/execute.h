// Runs a recorded frame. The bytes of all targets are a function of the frame and of what the
// targets held before; the number of threads has no part in it.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>

#include "raster/frame.h"
#include "raster/isa.h"

namespace gnomon::raster {

/// Memory that executions reuse: with it an execution like the last one allocates next to nothing.
/// For one execution at a time.
class ExecuteMemory {
 public:
  ExecuteMemory();
  ~ExecuteMemory();
  ExecuteMemory(const ExecuteMemory&) = delete;
  ExecuteMemory& operator=(const ExecuteMemory&) = delete;

  struct Parts;

 private:
  friend void execute(const Frame& frame, const struct ExecuteOptions& options);
  std::unique_ptr<Parts> parts_;
};

struct ExecuteOptions {
  /// 0: as many as the machine has; 1: all work on the calling thread, no scheduler is touched.
  int threads = 0;
  /// Instruction set of the kernels. Misuse: one that is not among available_isas().
  Isa isa = Isa::best;
  /// Null: memory for this execution alone.
  ExecuteMemory* memory = nullptr;
  /// Leave out the first so many commands (they were run before).
  std::size_t first_command = 0;
  /// Stop before this command, counted from the frame's first one.
  std::size_t commands = std::numeric_limits<std::size_t>::max();
};

/// Runs the frame's commands in recorded order at every pixel.
/// Effect on a target's pixel: exactly that of the commands one after the other (semantics:
/// docs/semantics.md).
void execute(const Frame& frame, const ExecuteOptions& options = {});

}  // namespace gnomon::raster
