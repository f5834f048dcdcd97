#include "raster/draw_fates.h"

#include "raster/check.h"
#include "raster/trace_draw.h"

namespace gnomon::raster {

namespace {

void count(std::uint16_t& counter) {
  if (counter < 0xffff) ++counter;
}

/// Depths and stencils, which alone decide what becomes of fragments.
std::vector<PixelValues> values_of(const Targets& targets) {
  std::vector<PixelValues> out;
  out.reserve(static_cast<std::size_t>(targets.width()) * targets.height());
  for (int y = 0; y < targets.height(); ++y)
    for (int x = 0; x < targets.width(); ++x)
      out.push_back({.depth = targets.depth ? targets.depth->at(x, y) : 0,
                     .stencil = targets.stencil ? targets.stencil->at(x, y) : std::uint8_t{0}});
  return out;
}

}  // namespace

DrawFates::DrawFates(int width_px, int height_px) : width(width_px), height(height_px) {
  for (auto* counts : {&stencil_failed, &depth_failed, &passed, &raised, &lowered})
    counts->assign(static_cast<std::size_t>(width) * height, 0);
}

void add_fates(const Command& command, const Targets& targets, DrawFates& fates) {
  require(fates.width == targets.width() && fates.height == targets.height(),
          "fates have the size of the targets");
  const Draw* const draw = std::get_if<Draw>(&command);
  if (!draw) return;
  const DrawTrace trace(*draw, targets);
  std::vector<PixelValues> values = values_of(targets);
  trace.for_each_fragment({0, 0, fates.width, fates.height}, [&](const TracedFragment& fragment) {
    const std::size_t at = static_cast<std::size_t>(fragment.y) * fates.width + fragment.x;
    const Outcome outcome = trace.test(fragment, values[at]);
    count((outcome == Outcome::stencil_fail ? fates.stencil_failed
           : outcome == Outcome::depth_fail ? fates.depth_failed
                                            : fates.passed)[at]);
    const StencilOp op = trace.stencil_op(fragment.triangle->front_facing, outcome);
    if (op == StencilOp::incr || op == StencilOp::incr_wrap) count(fates.raised[at]);
    if (op == StencilOp::decr || op == StencilOp::decr_wrap) count(fates.lowered[at]);
  });
}

}  // namespace gnomon::raster
