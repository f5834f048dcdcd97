#include "raster/tile.h"

#include <algorithm>
#include <array>

#include "raster/blend.h"
#include "raster/interpolate.h"
#include "raster/kernels.h"
#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

/// Offset of a block in a tile-linear plane, from its coordinates inside the tile in blocks.
std::size_t block_offset(int bx, int by) {
  return static_cast<std::size_t>(by * kBlocksPerTileRow + bx) * kPixelsPerBlock;
}

PixelBox tile_box(TileIndex tile) {
  return {tile.x * kTileSize, tile.y * kTileSize, (tile.x + 1) * kTileSize,
          (tile.y + 1) * kTileSize};
}

/// Pixels of the block at (x0, y0) that lie inside a box.
PixelMask box_mask(const PixelBox& box, int x0, int y0) {
  const int left = std::clamp(box.x0 - x0, 0, kBlockSize),
            right = std::clamp(box.x1 - x0, 0, kBlockSize);
  const int bottom = std::clamp(box.y0 - y0, 0, kBlockSize),
            top = std::clamp(box.y1 - y0, 0, kBlockSize);
  if (left >= right || bottom >= top) return 0;
  const PixelMask row = ((PixelMask{1} << (right - left)) - 1) << left;
  PixelMask mask = 0;
  for (int y = bottom; y < top; ++y) mask |= row << (y * kBlockSize);
  return mask;
}

/// Calls body(block's first pixel x, y, offset in the tile, mask of the box's pixels) for each 8x8
/// block that a box touches.
template <class Body>
void for_each_block(const PixelBox& box, TileIndex tile, Body body) {
  const PixelBox inside = intersect(box, tile_box(tile));
  if (inside.empty()) return;
  const int x0 = tile.x * kTileSize, y0 = tile.y * kTileSize;
  for (int by = (inside.y0 - y0) / kBlockSize; by <= (inside.y1 - 1 - y0) / kBlockSize; ++by)
    for (int bx = (inside.x0 - x0) / kBlockSize; bx <= (inside.x1 - 1 - x0) / kBlockSize; ++bx) {
      const int x = x0 + bx * kBlockSize, y = y0 + by * kBlockSize;
      body(x, y, block_offset(bx, by), box_mask(inside, x, y));
    }
}

/// Colours for the pixels of a block on their way to an RGBA8 target.
using Rgba8Block = std::array<Rgba8, kPixelsPerBlock>;

void write_rgba8(const Kernels& kernels, ColorBuffer& target, TileIndex tile, std::size_t offset,
                 const ColorState& state, PixelMask mask, const Rgba8Block& source) {
  const Rgba8 k = state.blend ? to_rgba8(state.blend->constant) : Rgba8{};
  Rgba8* const stored = target.rgba8().tile(tile.x, tile.y) + offset;
  kernels.blend_block(state, {k[0], k[1], k[2], k[3]}, mask, source.data()->data(), stored->data());
}

/// Writes the colours of the mask's pixels: of_pixel(i) in floats.
template <class OfPixel>
void write_block(const Kernels& kernels, ColorBuffer& target, TileIndex tile, std::size_t offset,
                 const ColorState& state, PixelMask mask, OfPixel of_pixel) {
  if (target.format() == ColorFormat::rgba32f) {
    glm::vec4* const stored = target.rgba32f().tile(tile.x, tile.y) + offset;
    for_each_pixel(
        mask, [&](std::size_t i) { stored[i] = blend_rgba32f(state, of_pixel(i), stored[i]); });
    return;
  }
  Rgba8Block source;
  for_each_pixel(mask, [&](std::size_t i) { source[i] = to_rgba8(of_pixel(i)); });
  write_rgba8(kernels, target, tile, offset, state, mask, source);
}

/// One colour for all pixels of the mask.
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

/// The draw's fragments all have one colour.
bool is_constant(const Draw& draw) {
  const Flat* flat = std::get_if<Flat>(&draw.shading);
  return flat && !flat->texture && !flat->depth_lookup && draw.mesh.colors.empty();
}

bool any(const std::array<bool, 4>& write) { return write[0] || write[1] || write[2] || write[3]; }

FragmentTests resolve_tests(const Draw& draw, const Targets& targets, bool front_facing) {
  FragmentTests tests;
  const State& state = draw.state;
  if (state.depth && targets.depth) {
    tests.depth_test = true;
    tests.depth_write = state.depth->write;
    tests.depth_func = state.depth->func;
  }
  if (state.stencil && targets.stencil) {
    tests.stencil_test = true;
    tests.stencil = front_facing ? state.stencil->front : state.stencil->back;
    const int ref = front_facing ? draw.stencil_ref.front : draw.stencil_ref.back;
    tests.stencil_ref = static_cast<std::uint8_t>(std::clamp(ref, 0, 255));
  }
  return tests;
}

/// The triangle's edges at the block whose first pixel is (x, y); false if an edge keeps the whole
/// block out.
bool edges_at_block(const SetupTriangle& triangle, int x, int y, BlockEdges& edges) {
  constexpr std::int64_t kSpan = kBlockSize - 1;
  edges.count = 0;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const std::int64_t value =
        (triangle.edge(k, x * std::int64_t{256} + 128, y * std::int64_t{256} + 128) -
         triangle.bias[i]) >>
        8;
    const std::int64_t a = triangle.a[i], b = triangle.b[i];
    const std::int64_t highest =
        value + std::max<std::int64_t>(a, 0) * kSpan + std::max<std::int64_t>(b, 0) * kSpan;
    if (highest < 0) return false;
    const std::int64_t lowest =
        value + std::min<std::int64_t>(a, 0) * kSpan + std::min<std::int64_t>(b, 0) * kSpan;
    if (lowest >= 0) continue;
    // An edge that crosses the block is within 7 (|a| + |b|) < 2^29 of zero in it.
    edges.value[edges.count] = static_cast<std::int32_t>(value);
    edges.step_x[edges.count] = triangle.a[i];
    edges.step_y[edges.count] = triangle.b[i];
    ++edges.count;
  }
  return true;
}

BlockDepth depth_at_tile(const DrawSetup& setup, const DepthPlane& plane, TileIndex tile) {
  BlockDepth depth;
  depth.fraction_bits = depth_fraction_bits(setup.depth_format);
  depth.base = plane.base_at(tile.x * kTileSize, tile.y * kTileSize) +
               (std::uint64_t{1} << (depth.fraction_bits - 1));
  depth.step_x = plane.step_x;
  depth.step_y = plane.step_y;
  depth.narrow = plane.narrow;
  depth.low = setup.depth_low;
  depth.high = setup.depth_high;
  return depth;
}

}  // namespace

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

FragmentSetup make_fragment_setup(const Draw& draw, const Targets& targets) {
  FragmentSetup setup;
  setup.front = resolve_tests(draw, targets, true);
  setup.back = resolve_tests(draw, targets, false);
  setup.color = targets.color && any(draw.state.color.write);
  if (setup.color && is_constant(draw)) setup.constant = shade(draw.shading, Fragment{});
  return setup;
}

void draw_tile(const Kernels& kernels, const DrawSetup& setup, const FragmentSetup& fragments,
               const SetupTriangle& triangle, const Targets& targets, TileIndex tile) noexcept {
  const Draw& draw = *setup.draw;
  const FragmentTests& tests = triangle.front_facing ? fragments.front : fragments.back;
  std::uint32_t* const depth =
      targets.depth ? targets.depth->plane().tile(tile.x, tile.y) : nullptr;
  std::uint8_t* const stencil =
      targets.stencil ? targets.stencil->plane().tile(tile.x, tile.y) : nullptr;
  const BlockDepth at_tile =
      tests.depth_test ? depth_at_tile(setup, triangle.depth, tile) : BlockDepth{};

  for_each_block(triangle.box, tile, [&](int x, int y, std::size_t offset, PixelMask in_box) {
    BlockEdges edges;
    if (!edges_at_block(triangle, x, y, edges)) return;
    const PixelMask covered = kernels.cover_block(edges) & in_box;
    if (!covered) return;
    BlockDepth plane = at_tile;
    plane.base += static_cast<std::uint64_t>(x - tile.x * kTileSize) * plane.step_x +
                  static_cast<std::uint64_t>(y - tile.y * kTileSize) * plane.step_y;
    const PixelMask passed =
        kernels.test_block(tests, covered, plane, depth ? depth + offset : nullptr,
                           stencil ? stencil + offset : nullptr);
    if (!fragments.color || !passed) return;
    if (fragments.constant) {
      write_constant(kernels, *targets.color, tile, offset, draw.state.color, passed,
                     *fragments.constant);
      return;
    }
    write_block(kernels, *targets.color, tile, offset, draw.state.color, passed,
                [&](std::size_t i) {
                  const int px = x + static_cast<int>(i) % kBlockSize,
                            py = y + static_cast<int>(i) / kBlockSize;
                  return shade(draw.shading, interpolate(draw, triangle, px, py));
                });
  });
}

}  // namespace gnomon::raster
