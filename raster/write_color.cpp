#include "raster/write_color.h"

namespace gnomon::raster {

void write_rgba8(const Kernels& kernels, ColorBuffer& target, TileIndex tile, std::size_t offset,
                 const ColorState& state, PixelMask mask, const Rgba8Block& source) {
  const Rgba8 k = state.blend ? to_rgba8(state.blend->constant) : Rgba8{};
  Rgba8* const stored = target.rgba8().tile(tile.x, tile.y) + offset;
  kernels.blend_block(state, {k[0], k[1], k[2], k[3]}, mask, source.data()->data(), stored->data());
}

void write_constant(const Kernels& kernels, ColorBuffer& target, TileIndex tile, std::size_t offset,
                    const ColorState& state, PixelMask mask, const glm::vec4& color) {
  if (target.format() == ColorFormat::rgba32f) {
    write_block(kernels, target, tile, offset, state, mask, [&](std::size_t) { return color; });
    return;
  }
  Rgba8Block source;
  source.fill(to_rgba8(color));
  write_rgba8(kernels, target, tile, offset, state, mask, source);
}

}  // namespace gnomon::raster
