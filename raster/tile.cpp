#include "raster/tile.h"

#include "raster/tile_blocks.h"
#include "raster/unorm.h"
#include "raster/write_color.h"

namespace gnomon::raster {

void clear_tile(const Kernels& kernels, const Clear& clear, const Targets& targets,
                TileIndex tile) noexcept {
  const ColorState color_state{clear.color_write, {}};
  const bool color = clear.color && any(clear.color_write);
  const bool depth = clear.depth && clear.depth_write;
  const std::uint32_t depth_value =
      depth ? float_to_depth(*clear.depth, targets.depth->format()) : 0;
  const std::uint8_t stencil_mask = clear.stencil_write_mask;
  for_each_block(
      scissor_box(clear.scissor, targets.width(), targets.height()), tile,
      [&](int, int, std::size_t offset, PixelMask mask) {
        if (color)
          write_constant(kernels, *targets.color, tile, offset, color_state, mask, *clear.color);
        if (depth) {
          std::uint32_t* const z = targets.depth->plane().tile(tile.x, tile.y) + offset;
          for_each_pixel(mask, [&](std::size_t i) { z[i] = depth_value; });
        }
        if (clear.stencil) {
          std::uint8_t* const s = targets.stencil->plane().tile(tile.x, tile.y) + offset;
          for_each_pixel(mask, [&](std::size_t i) {
            s[i] =
                static_cast<std::uint8_t>((s[i] & ~stencil_mask) | (*clear.stencil & stencil_mask));
          });
        }
      });
}

void blit_tile(const Kernels& kernels, const Blit& blit, const Targets& targets,
               TileIndex tile) noexcept {
  ColorBuffer& target = *targets.color;
  const PixelBox image_box = scissor_box(Rect{blit.x, blit.y, blit.image.width, blit.image.height},
                                         target.width(), target.height());
  const PixelBox box =
      intersect(image_box, scissor_box(blit.scissor, target.width(), target.height()));
  const ColorState state{blit.color_write, {}};
  for_each_block(box, tile, [&](int x, int y, std::size_t offset, PixelMask mask) {
    const auto pixel = [&](std::size_t i) -> Rgba8 {
      const int px = x + static_cast<int>(i) % kBlockSize,
                py = y + static_cast<int>(i) / kBlockSize;
      const std::uint8_t* c = blit.image.pixel(px - blit.x, py - blit.y);
      return {c[0], c[1], c[2], blit.image.channels == 4 ? c[3] : std::uint8_t{0}};
    };
    if (target.format() == ColorFormat::rgba32f) {
      write_block(kernels, target, tile, offset, state, mask,
                  [&](std::size_t i) { return to_floats(pixel(i)); });
      return;
    }
    Rgba8Block source;
    for_each_pixel(mask, [&](std::size_t i) { source[i] = pixel(i); });
    write_rgba8(kernels, target, tile, offset, state, mask, source);
  });
}

}  // namespace gnomon::raster
