#include "raster/write_color.h"

#include <cstring>

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
  const Rgba8 rounded = to_rgba8(color);
  if (!state.blend && state.write == std::array<bool, 4>{true, true, true, true}) {
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, rounded.data(), sizeof bytes);
    kernels.fill_block(bytes, mask, (target.rgba8().tile(tile.x, tile.y) + offset)->data());
    return;
  }
  Rgba8Block source;
  source.fill(rounded);
  write_rgba8(kernels, target, tile, offset, state, mask, source);
}

}  // namespace gnomon::raster
