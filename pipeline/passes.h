// Finding the passes of a recorded frame by their labels, to run a frame as far as one of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "raster/frame.h"

namespace gnomon::pipeline {

/// How many commands to run (raster::ExecuteOptions::commands) to stop just after the last pass
/// whose label is `label` or begins with `label` and ": " (the same pass of one light among
/// several). Absent when no pass has that label.
std::optional<std::size_t> commands_through(const raster::Frame& frame, std::string_view label);

/// The same for the pass of that number.
/// Precondition: pass is below the number of passes.
std::size_t commands_through_pass(const raster::Frame& frame, std::size_t pass);

}  // namespace gnomon::pipeline
