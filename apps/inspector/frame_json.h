// A frame and what happened at a pixel of it as JSON, for pages and programs: what a command is in
// OpenGL's words, and the fate of each fragment.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/inspector/frame_buffers.h"
#include "raster/frame.h"
#include "raster/history.h"

namespace gnomon::apps::inspector {

/// {"buffers": [{kind, format, width, height}], "passes": [{label, size, targets, commands: [{kind,
/// label, ...its state}]}]}. Buffers are named by their number. In brief, "commands" is how many
/// there are.
nlohmann::ordered_json frame_json(const raster::Frame& frame, const FrameBuffers& buffers,
                                  bool in_brief = false);

/// {"x", "y", "commands": [{pass, command, kind, label, before, after, fragments: [{triangle, part,
/// facing, depth, outcome, stencil_op, before, after}]}]}. Values are {color, depth, stencil} of
/// the buffers that the pass has: 8-bit channels as integers, others as they are (not a number:
/// null).
nlohmann::ordered_json history_json(const raster::Frame& frame,
                                    const raster::PixelHistory& history);

/// A command and its pass.
struct Place {
  const raster::Pass* pass = nullptr;
  const raster::Command* command = nullptr;
};

/// Of the command of that number, counted from the frame's first one. Misuse: there is none.
Place place_of(const raster::Frame& frame, std::size_t command);

}  // namespace gnomon::apps::inspector
