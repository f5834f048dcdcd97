#include "pipeline/count_volumes.h"

#include <algorithm>

#include "pipeline/full_screen.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

raster::StencilFace face(const CountOptions& options, VolumeMethod method, raster::StencilOp op) {
  raster::StencilFace result;
  result.write_mask = options.write_mask;
  (method == VolumeMethod::zpass ? result.pass : result.depth_fail) = op;
  return result;
}

raster::Draw counting_draw(const PlacedVolume& volume, const CountOptions& options) {
  raster::Draw draw;
  draw.state = surface_state();
  draw.state.depth = raster::DepthState{.func = raster::CompareFunc::less, .write = false};
  draw.state.color = raster::ColorState::off();
  draw.state.front_face = volume.front_face;
  draw.state.scissor = volume.window;
  const bool front_cap =
      !options.casters_drawn || !volume.cap_is_drawn || volume.method != VolumeMethod::zpass;
  draw.mesh = front_cap ? volume.volume->view() : volume.volume->view_without_front_cap();
  draw.parts = volume.volume->parts(front_cap);
  draw.clip_from_model = volume.clip_from_model;
  draw.label = "volume of " + volume.caster->name;
  if (!options.light_name.empty()) draw.label += " from " + options.light_name;
  draw.label += volume.method == VolumeMethod::zpass ? " (z-pass)" : " (z-fail)";
  return draw;
}

void count_two_sided(raster::Frame& frame, const PlacedVolume& volume,
                     const CountOptions& options) {
  raster::Draw draw = counting_draw(volume, options);
  const bool zpass = volume.method == VolumeMethod::zpass;
  using raster::StencilOp;
  draw.state.stencil = raster::StencilState{
      face(options, volume.method, zpass ? StencilOp::incr_wrap : StencilOp::decr_wrap),
      face(options, volume.method, zpass ? StencilOp::decr_wrap : StencilOp::incr_wrap)};
  frame.draw(std::move(draw));
}

/// One of two draws: the faces that add, or those that take away.
void count_single_sided(raster::Frame& frame, const PlacedVolume& volume,
                        const CountOptions& options, bool add) {
  raster::Draw draw = counting_draw(volume, options);
  const bool front = (volume.method == VolumeMethod::zpass) == add;
  draw.state.cull = front ? raster::Cull::back : raster::Cull::front;
  using raster::StencilOp;
  const StencilOp up = options.appendix_letter ? StencilOp::incr : StencilOp::incr_wrap;
  const StencilOp down = options.appendix_letter ? StencilOp::decr : StencilOp::decr_wrap;
  draw.state.stencil = raster::StencilState::both(face(options, volume.method, add ? up : down));
  draw.label += front ? ", front faces" : ", back faces";
  frame.draw(std::move(draw));
}

void count_at_once(raster::Frame& frame, std::span<const PlacedVolume> volumes,
                   const CountOptions& options) {
  if (!options.appendix_letter && !options.single_sided) {
    for (const PlacedVolume& volume : volumes) count_two_sided(frame, volume, options);
    return;
  }
  for (const bool add : {true, false}) {
    for (const PlacedVolume& volume : volumes) count_single_sided(frame, volume, options, add);
  }
}

void count_in_batches(raster::Frame& frame, std::span<const PlacedVolume> volumes,
                      CountOptions options) {
  const std::uint8_t bits = options.write_mask;
  raster::require((bits & (bits + 1)) == 0 && bits > 2 * kLayers,
                  "counts in batches have the low bits, and some");
  options.write_mask = bits >> 1;
  const std::size_t batch = options.write_mask / kLayers;
  for (std::size_t first = 0; first < volumes.size(); first += batch) {
    count_at_once(frame, volumes.subspan(first, std::min(batch, volumes.size() - first)), options);
    flag_counts(frame, options.write_mask, bits);
  }
}

}  // namespace

void count_volumes(raster::Frame& frame, std::span<const PlacedVolume> volumes,
                   const CountOptions& options) {
  for (const PlacedVolume& volume : volumes) frame.keep(volume.volume);
  const bool fit = volumes.size() * kLayers <= options.write_mask;
  if (fit || !options.in_batches || options.appendix_letter)
    count_at_once(frame, volumes, options);
  else
    count_in_batches(frame, volumes, options);
}

}  // namespace gnomon::pipeline
