#include "replay_file.h"

#include <sstream>
#include <stdexcept>
#include <utility>

#include "compare.h"
#include "explain.h"
#include "peer/osmesa/osmesa_context.h"
#include "raster/execute.h"
#include "replay.h"

namespace gnomon::peer {

using namespace gnomon::raster;

namespace {

Targets main_targets(const Frame& frame) {
  Targets found;
  for (const Pass& pass : frame.passes())
    if (pass.targets.color && pass.targets.depth && pass.targets.stencil) found = pass.targets;
  if (!found.color)
    throw std::runtime_error("the frame has no pass with colour, depth and stencil");
  if (found.depth->format() != DepthFormat::d24)
    throw std::runtime_error("the frame's depth is not D24, which is what OpenGL has here");
  return found;
}

bool shares(const Targets& a, const Targets& b) {
  return (a.color && a.color == b.color) || (a.depth && a.depth == b.depth) ||
         (a.stencil && a.stencil == b.stencil);
}

Buffers read(const Targets& targets) {
  return {targets.stencil->to_rows(), targets.depth->to_rows(), targets.color->to_rgba8_rows()};
}

/// Colour of a lit draw is not replayed, RGBA32F is rounded once where OpenGL rounds every draw.
bool colors_compare(const Pass& pass) {
  if (pass.targets.color && pass.targets.color->format() != ColorFormat::rgba8) return false;
  for (const Command& command : pass.commands)
    if (const Draw* draw = std::get_if<Draw>(&command))
      if (std::holds_alternative<Lit>(draw->shading)) return false;
  return true;
}

}  // namespace

FrameReplay replay_frame(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  const Targets main = main_targets(frame);
  const OsmesaContext context(main.width(), main.height());
  reset(context);
  FrameReplay out{.is_llvmpipe = context.is_llvmpipe()};
  std::ostringstream text;
  text << context.renderer() << ", " << main.width() << " x " << main.height() << "\n";
  Buffers before = read(main), before_gl = read_back(context);
  std::size_t done = 0;
  bool colors = true;
  for (const Pass& pass : frame.passes()) {
    const std::size_t end = done + pass.commands.size();
    raster::execute(frame, {.first_command = done, .commands = end});
    done = end;
    if (!shares(pass.targets, main)) {
      text << "  " << pass.label << ": on gnomon alone\n";
      continue;
    }
    replay(context, pass, main.color);
    Buffers after = read(main), after_gl = read_back(context);
    const Step step{before, before_gl, after, after_gl, main.width(), main.height()};
    const StencilCauses stencil = explain_stencil(pass, step);
    const DepthCauses depth = explain_depth(pass, step);
    colors = colors && colors_compare(pass);
    const Differing differing = compare(after, after_gl);
    text << "  " << pass.label << ": stencil " << stencil.differing << " = " << stencil.coverage
         << " edge + " << stencil.depth_tie << " tie + " << stencil.earlier << " earlier + "
         << stencil.unexplained << " unexplained; depth " << depth.differing
         << ", by more than 2 units " << depth.large << " = " << depth.coverage << " edge + "
         << depth.steep << " steep + " << depth.earlier << " earlier + " << depth.unexplained
         << " unexplained; colour ";
    if (colors)
      text << differing.color << "\n";
    else
      text << "not compared\n";
    out.differing += differing.stencil + differing.depth + (colors ? differing.color : 0);
    out.unexplained += stencil.unexplained + depth.unexplained;
    before = std::move(after);
    before_gl = std::move(after_gl);
  }
  out.text = text.str();
  return out;
}

}  // namespace gnomon::peer
