#include "raster/write_color.h"

#include <cstring>

#include "raster/blend.h"
#include "raster/unorm.h"

namespace gnomon::raster {

BlockWriter::BlockWriter(const Kernels& kernels, ColorBuffer& target, TileIndex tile,
                         const ColorState& state)
    : kernels_(kernels),
      state_(state),
      plain_(!state.blend && state.write == std::array<bool, 4>{true, true, true, true}) {
  if (state.blend) constant_ = to_rgba8(state.blend->constant);
  if (target.format() == ColorFormat::rgba8)
    rgba8_ = target.rgba8().tile(tile.x, tile.y);
  else
    rgba32f_ = target.rgba32f().tile(tile.x, tile.y);
}

ColorTile BlockWriter::tile() const {
  return {rgba8_ ? rgba8_->data() : nullptr,
          rgba32f_ ? &rgba32f_->x : nullptr,
          &state_,
          {constant_[0], constant_[1], constant_[2], constant_[3]}};
}

void BlockWriter::write(std::size_t b, PixelMask mask, const ColorPlanes& colors) const {
  if (rgba8_ && plain_) {
    kernels_.store_colors(colors.data(), mask, (rgba8_ + b * kPixelsPerBlock)->data());
    return;
  }
  if (rgba8_) {
    Rgba8Block rounded;
    kernels_.store_colors(colors.data(), mask, rounded.data()->data());
    write(b, mask, rounded);
    return;
  }
  glm::vec4* const stored = rgba32f_ + b * kPixelsPerBlock;
  for_each_pixel(mask, [&](std::size_t i) {
    const auto channel = [&](std::size_t c) { return colors[c * kPixelsPerBlock + i]; };
    stored[i] = blend_rgba32f(state_, {channel(0), channel(1), channel(2), channel(3)}, stored[i]);
  });
}

void BlockWriter::write(std::size_t b, PixelMask mask, const glm::vec4& color) const {
  if (rgba32f_) {
    glm::vec4* const stored = rgba32f_ + b * kPixelsPerBlock;
    for_each_pixel(mask,
                   [&](std::size_t i) { stored[i] = blend_rgba32f(state_, color, stored[i]); });
    return;
  }
  const Rgba8 rounded = to_rgba8(color);
  if (plain_) {
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, rounded.data(), sizeof bytes);
    kernels_.fill_block(bytes, mask, (rgba8_ + b * kPixelsPerBlock)->data());
    return;
  }
  Rgba8Block source;
  source.fill(rounded);
  write(b, mask, source);
}

void BlockWriter::write(std::size_t b, PixelMask mask, const Rgba8Block& colors) const {
  kernels_.blend_block(state_, {constant_[0], constant_[1], constant_[2], constant_[3]}, mask,
                       colors.data()->data(), (rgba8_ + b * kPixelsPerBlock)->data());
}

}  // namespace gnomon::raster
