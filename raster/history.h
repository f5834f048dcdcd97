// What happened at one pixel: every command that touched it and every fragment, in order, with what
// was stored before and after.
// Invariant: the values after the last command are the bytes that execute() leaves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "raster/execute.h"
#include "raster/fragment_fate.h"
#include "raster/frame.h"

namespace gnomon::raster {

/// A fragment at the pixel.
struct FragmentRecord {
  /// Of the draw's mesh.
  std::uint32_t triangle = 0;
  bool front_facing = true;
  /// In units of the depth target, as PixelValues::depth.
  std::uint32_t depth = 0;
  Outcome outcome = Outcome::pass;
  /// What the stencil test's result asked for; keep without a stencil test.
  StencilOp stencil_op = StencilOp::keep;
  PixelValues before, after;
};

/// A command that touched the pixel: a clear or a blit that covers it, or a draw with fragments
/// there.
struct CommandRecord {
  /// Counted from the frame's first pass and first command.
  std::size_t pass = 0, command = 0;
  PixelValues before, after;
  /// Of a draw.
  std::vector<FragmentRecord> fragments = {};
};

struct PixelHistory {
  int x = 0, y = 0;
  std::vector<CommandRecord> commands;
};

struct HistoryOptions {
  /// The pass whose targets are asked about; absent: the frame's last one. Passes that share one of
  /// its buffers are part of the history, others (a shadow map's) are not.
  std::optional<std::size_t> pass = {};
  /// Stop before this command, counted from the frame's first one.
  std::size_t commands = std::numeric_limits<std::size_t>::max();
  /// As ExecuteOptions::threads.
  int threads = 0;
};

/// Executes the frame and tells of one pixel, (0, 0) being the bottom left one. The targets hold
/// afterwards what execute() leaves in them. Misuse: a frame without a pass, a pass that is not
/// there, a pixel outside its targets.
PixelHistory history(const Frame& frame, int x, int y, const HistoryOptions& options = {});

}  // namespace gnomon::raster
