#include "raster/tile.h"

#include <algorithm>
#include <optional>

#include "raster/tile_blocks.h"
#include "raster/unorm.h"
#include "raster/write_color.h"

namespace gnomon::raster {

namespace {

void clear_depths(std::uint32_t value, std::size_t block, PixelMask mask,
                  const TilePixels& pixels) {
  std::uint32_t* const depth = pixels.depth() + block * kPixelsPerBlock;
  if (mask == kAllPixels) {
    std::fill_n(depth, kPixelsPerBlock, value);
    pixels.ranges().set(block, value, value);
    return;
  }
  for_each_pixel(mask, [&](std::size_t i) { depth[i] = value; });
  pixels.ranges().forget(block);
}

void clear_stencils(std::uint8_t value, std::uint8_t write_mask, PixelMask mask,
                    std::uint8_t* stencil) {
  if (mask == kAllPixels && write_mask == 0xff) {
    std::fill_n(stencil, kPixelsPerBlock, value);
    return;
  }
  for_each_pixel(mask, [&](std::size_t i) {
    stencil[i] = static_cast<std::uint8_t>((stencil[i] & ~write_mask) | (value & write_mask));
  });
}

}  // namespace

void clear_tile(const Clear& clear, TilePixels& pixels) noexcept {
  const Targets& targets = pixels.targets();
  const ColorState color_state{clear.color_write, {}};
  const bool color = clear.color && any(clear.color_write);
  const bool depth = clear.depth && clear.depth_write;
  const std::uint32_t depth_value =
      depth ? float_to_depth(*clear.depth, targets.depth->format()) : 0;
  if (clear.stencil) pixels.add_counts();
  std::optional<BlockWriter> writer;
  if (color) writer.emplace(pixels.kernels(), *targets.color, pixels.tile(), color_state);
  for_each_block(scissor_box(clear.scissor, targets.width(), targets.height()), pixels.tile(),
                 [&](std::size_t block, PixelMask mask) {
                   if (color) writer->write(block, mask, *clear.color);
                   if (depth) clear_depths(depth_value, block, mask, pixels);
                   if (clear.stencil)
                     clear_stencils(static_cast<std::uint8_t>(*clear.stencil),
                                    clear.stencil_write_mask, mask,
                                    pixels.stencil() + block * kPixelsPerBlock);
                 });
}

void blit_tile(const Blit& blit, TilePixels& pixels) noexcept {
  const TileIndex tile = pixels.tile();
  ColorBuffer& target = *pixels.targets().color;
  const PixelBox image_box = scissor_box(Rect{blit.x, blit.y, blit.image.width, blit.image.height},
                                         target.width(), target.height());
  const PixelBox box =
      intersect(image_box, scissor_box(blit.scissor, target.width(), target.height()));
  const ColorState state{blit.color_write, {}};
  const BlockWriter writer(pixels.kernels(), target, tile, state);
  for_each_block(box, tile, [&](std::size_t block, PixelMask mask) {
    const int x = tile.x * kTileSize + block_x(block), y = tile.y * kTileSize + block_y(block);
    const auto pixel = [&](std::size_t i) -> Rgba8 {
      const int px = x + static_cast<int>(i) % kBlockSize,
                py = y + static_cast<int>(i) / kBlockSize;
      const std::uint8_t* c = blit.image.pixel(px - blit.x, py - blit.y);
      return {c[0], c[1], c[2], blit.image.channels == 4 ? c[3] : std::uint8_t{0}};
    };
    if (writer.is_rgba8()) {
      Rgba8Block source;
      for_each_pixel(mask, [&](std::size_t i) { source[i] = pixel(i); });
      writer.write(block, mask, source);
      return;
    }
    ColorPlanes source;
    for_each_pixel(mask, [&](std::size_t i) { set_color(source, i, to_floats(pixel(i))); });
    writer.write(block, mask, source);
  });
}

}  // namespace gnomon::raster
