// The kernels in plain C++, and the choice among all of them.
#include "raster/kernels.h"

#include <algorithm>
#include <cstring>

#include "raster/blend.h"
#include "raster/check.h"
#include "raster/stencil_op.h"
#include "raster/tiled_plane.h"
#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

/// Bit i of the result is predicate(i). Full rows of a block at a time keep the loop vectorizable.
template <class Predicate>
PixelMask gather_mask(Predicate predicate) {
  PixelMask mask = 0;
  for (int y = 0; y < kBlockSize; ++y) {
    std::uint32_t row = 0;
    for (int x = 0; x < kBlockSize; ++x)
      row |= static_cast<std::uint32_t>(predicate(y * kBlockSize + x)) << x;
    mask |= static_cast<PixelMask>(row) << (y * kBlockSize);
  }
  return mask;
}

template <class Left, class Right>
PixelMask compare_mask(CompareFunc func, Left left, Right right) {
  switch (func) {
    case CompareFunc::never:
      return 0;
    case CompareFunc::less:
      return gather_mask([&](int i) { return left(i) < right(i); });
    case CompareFunc::equal:
      return gather_mask([&](int i) { return left(i) == right(i); });
    case CompareFunc::less_equal:
      return gather_mask([&](int i) { return left(i) <= right(i); });
    case CompareFunc::greater:
      return gather_mask([&](int i) { return left(i) > right(i); });
    case CompareFunc::not_equal:
      return gather_mask([&](int i) { return left(i) != right(i); });
    case CompareFunc::greater_equal:
      return gather_mask([&](int i) { return left(i) >= right(i); });
    case CompareFunc::always:
      return kAllPixels;
  }
  return 0;
}

/// The 64 depths of block b.
void depth_values(const TileDepth& plane, std::size_t b, std::uint32_t (&out)[kPixelsPerBlock]) {
  const std::uint64_t base = plane.base + static_cast<std::uint64_t>(block_x(b)) * plane.step_x +
                             static_cast<std::uint64_t>(block_y(b)) * plane.step_y;
  if (plane.narrow) {
    const auto low_base = static_cast<std::uint32_t>(base);
    const auto step_x = static_cast<std::uint32_t>(plane.step_x);
    const auto step_y = static_cast<std::uint32_t>(plane.step_y);
    for (std::uint32_t y = 0; y < kBlockSize; ++y)
      for (std::uint32_t x = 0; x < kBlockSize; ++x)
        out[y * kBlockSize + x] = (low_base + x * step_x + y * step_y) >> plane.fraction_bits;
    return;
  }
  for (std::uint64_t y = 0; y < kBlockSize; ++y)
    for (std::uint64_t x = 0; x < kBlockSize; ++x) {
      const auto value = static_cast<std::int64_t>(base + x * plane.step_x + y * plane.step_y);
      out[y * kBlockSize + x] = static_cast<std::uint32_t>(
          std::clamp<std::int64_t>(value >> plane.fraction_bits, plane.low, plane.high));
    }
}

void update_stencil(StencilOp op, PixelMask mask, std::uint8_t ref, std::uint8_t write_mask,
                    std::uint8_t* stencil) {
  if (op == StencilOp::keep || write_mask == 0) return;
  for_each_pixel(
      mask, [&](std::size_t i) { stencil[i] = stencil_after(op, stencil[i], ref, write_mask); });
}

/// Of 8x8 samples those where value + x * step_x + y * step_y is negative.
std::uint64_t negative(std::int32_t value, std::int32_t step_x, std::int32_t step_y) {
  return gather_mask([&](int i) { return value + (i % 8) * step_x + (i / 8) * step_y < 0; });
}

BlockMask cover_blocks(const TileEdges& edges, BlockMask& filled) noexcept {
  constexpr std::int32_t kSpan = kBlockSize - 1;
  BlockMask outside = 0, crossed = 0;
  for (int k = 0; k < edges.count; ++k) {
    const std::int32_t dx = edges.step_x[k], dy = edges.step_y[k];
    const std::int32_t up = std::max(dx, 0) + std::max(dy, 0),
                       down = std::min(dx, 0) + std::min(dy, 0);
    outside |= negative(edges.value[k] + up * kSpan, dx * kBlockSize, dy * kBlockSize);
    crossed |= negative(edges.value[k] + down * kSpan, dx * kBlockSize, dy * kBlockSize);
  }
  filled = ~crossed;
  return ~outside;
}

BlockMask cover_pixels(const TileEdges& edges, BlockMask blocks, PixelMask* covered) noexcept {
  BlockMask touched = 0;
  for_each_block_of(blocks, [&](std::size_t b) {
    const int x = block_x(b), y = block_y(b);
    PixelMask outside = 0;
    for (int k = 0; k < edges.count; ++k)
      outside |= negative(edges.value[k] + x * edges.step_x[k] + y * edges.step_y[k],
                          edges.step_x[k], edges.step_y[k]);
    covered[b] = ~outside;
    if (~outside) touched |= BlockMask{1} << b;
  });
  return touched;
}

DecidedBlocks compare_ranges(const BlockDepths& depths, const std::uint32_t* least,
                             const std::uint32_t* greatest, std::int32_t below_slack,
                             std::int32_t above_slack) noexcept {
  DecidedBlocks decided;
  decided.below = gather_mask([&](int b) {
    const std::int32_t high =
        depths.high + (b % 8) * depths.high_step_x + (b / 8) * depths.high_step_y;
    return std::clamp(high, depths.least, depths.greatest) <
           static_cast<std::int32_t>(least[b]) + below_slack;
  });
  decided.above = gather_mask([&](int b) {
    const std::int32_t low = depths.low + (b % 8) * depths.low_step_x + (b / 8) * depths.low_step_y;
    return std::clamp(low, depths.least, depths.greatest) >
           static_cast<std::int32_t>(greatest[b]) - above_slack;
  });
  return decided;
}

PixelMask test_stencil(const FragmentTests& tests, const std::uint8_t* stencil) {
  const StencilFace& face = tests.stencil;
  const std::uint8_t ref = tests.stencil_ref & face.read_mask;
  return compare_mask(
      face.func, [&](int) { return ref; },
      [&](int i) { return static_cast<std::uint8_t>(stencil[i] & face.read_mask); });
}

/// Of the pixels `candidates` of block b those that pass the depth test; they are written if asked
/// for.
PixelMask test_depth(const FragmentTests& tests, const TestedBlocks& tested, std::size_t b,
                     PixelMask candidates) {
  std::uint32_t* const depth = tested.depth + b * kPixelsPerBlock;
  std::uint32_t z[kPixelsPerBlock];
  depth_values(tested.plane, b, z);
  const CompareFunc func = (tested.depth_passes >> b & 1)  ? CompareFunc::always
                           : (tested.depth_fails >> b & 1) ? CompareFunc::never
                                                           : tests.depth_func;
  const PixelMask passed =
      candidates & compare_mask(
                       func, [&](int i) { return z[i]; }, [&](int i) { return depth[i]; });
  if (tests.depth_write) for_each_pixel(passed, [&](std::size_t i) { depth[i] = z[i]; });
  return passed;
}

PixelMask test_block(const FragmentTests& tests, const TestedBlocks& tested, std::size_t b,
                     PixelMask covered) {
  const StencilFace& face = tests.stencil;
  std::uint8_t* const stencil = tests.stencil_test ? tested.stencil + b * kPixelsPerBlock : nullptr;
  const auto update = [&](StencilOp op, PixelMask pixels) {
    if (stencil) update_stencil(op, pixels, tests.stencil_ref, face.write_mask, stencil);
  };
  const PixelMask stencil_pass = stencil ? covered & test_stencil(tests, stencil) : covered;
  update(face.fail, covered & ~stencil_pass);
  const PixelMask pass =
      tests.depth_test && stencil_pass ? test_depth(tests, tested, b, stencil_pass) : stencil_pass;
  update(face.depth_fail, stencil_pass & ~pass);
  update(face.pass, pass);
  return pass;
}

BlockMask test_blocks(const FragmentTests& tests, const TestedBlocks& tested,
                      PixelMask* covered) noexcept {
  BlockMask passed = 0;
  for_each_block_of(tested.blocks, [&](std::size_t b) {
    covered[b] = test_block(tests, tested, b, covered[b]);
    if (covered[b]) passed |= BlockMask{1} << b;
  });
  return passed;
}

void count_blocks(CompareFunc func, bool on_pass, std::uint8_t delta, const TestedBlocks& tested,
                  const PixelMask* covered) noexcept {
  const FragmentTests tests{.depth_test = true, .depth_func = func};
  for_each_block_of(tested.blocks, [&](std::size_t b) {
    const PixelMask passed = test_depth(tests, tested, b, covered[b]);
    std::uint8_t* const stencil = tested.stencil + b * kPixelsPerBlock;
    for_each_pixel(on_pass ? passed : covered[b] & ~passed, [&](std::size_t i) {
      stencil[i] = static_cast<std::uint8_t>(stencil[i] + delta);
    });
  });
}

void add_to_blocks(const std::uint8_t* deltas, std::uint8_t* stencil) noexcept {
  for (int i = 0; i < kPixelsPerTile; ++i)
    stencil[i] = static_cast<std::uint8_t>(stencil[i] + deltas[i / kPixelsPerBlock]);
}

BlockMask stencil_blocks(const FragmentTests& tests, const std::uint8_t* stencil) noexcept {
  BlockMask blocks = 0;
  for (std::size_t b = 0; b < kBlocksPerTile; ++b)
    if (test_stencil(tests, stencil + b * kPixelsPerBlock)) blocks |= BlockMask{1} << b;
  return blocks;
}

void depth_range(const std::uint32_t* depth, std::uint32_t& least,
                 std::uint32_t& greatest) noexcept {
  const auto [low, high] = std::minmax_element(depth, depth + kPixelsPerBlock);
  least = *low;
  greatest = *high;
}

void fill_block(std::uint32_t color, PixelMask mask, std::uint8_t* stored) noexcept {
  for_each_pixel(mask, [&](std::size_t i) { std::memcpy(stored + 4 * i, &color, 4); });
}

void blend_block(const ColorState& state, const std::uint8_t (&constant)[4], PixelMask mask,
                 const std::uint8_t* source, std::uint8_t* stored) noexcept {
  const Rgba8 k{constant[0], constant[1], constant[2], constant[3]};
  for_each_pixel(mask, [&](std::size_t i) {
    Rgba8 from, to;
    std::memcpy(from.data(), source + 4 * i, 4);
    std::memcpy(to.data(), stored + 4 * i, 4);
    to = blend_rgba8(state, k, from, to);
    std::memcpy(stored + 4 * i, to.data(), 4);
  });
}

void store_colors(const float* colors, PixelMask mask, std::uint8_t* stored) noexcept {
  for_each_pixel(mask, [&](std::size_t i) {
    for (std::size_t c = 0; c < 4; ++c)
      stored[4 * i + c] = float_to_unorm8(colors[c * kPixelsPerBlock + i]);
  });
}

void transform(const glm::mat4& m, const glm::vec4* positions, std::size_t count,
               glm::vec4* out) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec4 p = positions[i];
    for (int row = 0; row < 4; ++row)
      out[i][row] = ((m[0][row] * p.x + m[1][row] * p.y) + m[2][row] * p.z) + m[3][row] * p.w;
  }
}

}  // namespace

const Kernels& scalar_kernels() {
  static constexpr Kernels kKernels{
      cover_blocks,   cover_pixels, compare_ranges,   test_blocks, count_blocks,    add_to_blocks,
      stencil_blocks, depth_range,  fill_block,       blend_block, nullptr,         nullptr,
      store_colors,   transform,    project_vertices, nullptr,     select_triangles};
  return kKernels;
}

const Kernels& kernels(Isa isa) {
  if (isa == Isa::best) isa = available_isas().back();
  if (isa == Isa::scalar) return scalar_kernels();
  const Kernels* found = simd_kernels(isa);
  require(found != nullptr, "an instruction set is one that this machine has");
  return *found;
}

}  // namespace gnomon::raster
