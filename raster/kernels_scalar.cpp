// The kernels in plain C++, and the choice among all of them.
#include "raster/kernels.h"

#include <algorithm>
#include <cstring>

#include "raster/blend.h"
#include "raster/check.h"
#include "raster/tiled_plane.h"

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

/// The stencil value after op, before the write mask.
std::uint8_t apply(StencilOp op, std::uint8_t value, std::uint8_t ref) {
  switch (op) {
    case StencilOp::keep:
      return value;
    case StencilOp::zero:
      return 0;
    case StencilOp::replace:
      return ref;
    case StencilOp::incr:
      return value == 255 ? value : static_cast<std::uint8_t>(value + 1);
    case StencilOp::incr_wrap:
      return static_cast<std::uint8_t>(value + 1);
    case StencilOp::decr:
      return value == 0 ? value : static_cast<std::uint8_t>(value - 1);
    case StencilOp::decr_wrap:
      return static_cast<std::uint8_t>(value - 1);
    case StencilOp::invert:
      return static_cast<std::uint8_t>(~value);
  }
  return value;
}

void depth_values(const BlockDepth& plane, std::uint32_t (&out)[kPixelsPerBlock]) {
  if (plane.narrow) {
    const auto base = static_cast<std::uint32_t>(plane.base);
    const auto step_x = static_cast<std::uint32_t>(plane.step_x);
    const auto step_y = static_cast<std::uint32_t>(plane.step_y);
    for (std::uint32_t y = 0; y < kBlockSize; ++y)
      for (std::uint32_t x = 0; x < kBlockSize; ++x)
        out[y * kBlockSize + x] = (base + x * step_x + y * step_y) >> plane.fraction_bits;
    return;
  }
  for (std::uint64_t y = 0; y < kBlockSize; ++y)
    for (std::uint64_t x = 0; x < kBlockSize; ++x) {
      const auto value =
          static_cast<std::int64_t>(plane.base + x * plane.step_x + y * plane.step_y);
      out[y * kBlockSize + x] = static_cast<std::uint32_t>(
          std::clamp<std::int64_t>(value >> plane.fraction_bits, plane.low, plane.high));
    }
}

void update_stencil(StencilOp op, PixelMask mask, std::uint8_t ref, std::uint8_t write_mask,
                    std::uint8_t* stencil) {
  if (op == StencilOp::keep || write_mask == 0) return;
  for_each_pixel(mask, [&](std::size_t i) {
    const std::uint8_t old = stencil[i];
    stencil[i] =
        static_cast<std::uint8_t>((old & ~write_mask) | (apply(op, old, ref) & write_mask));
  });
}

PixelMask cover_grid(const GridEdges& edges) noexcept {
  PixelMask mask = kAllPixels;
  for (int k = 0; k < edges.count && mask; ++k) {
    const std::int32_t value = edges.value[k], dx = edges.step_x[k], dy = edges.step_y[k];
    mask &= gather_mask(
        [&](int i) { return value + (i % kBlockSize) * dx + (i / kBlockSize) * dy >= 0; });
  }
  return mask;
}

PixelMask test_block(const FragmentTests& tests, PixelMask covered, const BlockDepth& plane,
                     std::uint32_t* depth, std::uint8_t* stencil) noexcept {
  PixelMask stencil_pass = covered;
  const StencilFace& face = tests.stencil;
  if (tests.stencil_test) {
    const std::uint8_t ref = tests.stencil_ref & face.read_mask;
    stencil_pass &= compare_mask(
        face.func, [&](int) { return ref; },
        [&](int i) { return static_cast<std::uint8_t>(stencil[i] & face.read_mask); });
    update_stencil(face.fail, covered & ~stencil_pass, tests.stencil_ref, face.write_mask, stencil);
  }
  PixelMask pass = stencil_pass;
  if (tests.depth_test && stencil_pass) {
    std::uint32_t z[kPixelsPerBlock];
    depth_values(plane, z);
    pass &= compare_mask(
        tests.depth_func, [&](int i) { return z[i]; }, [&](int i) { return depth[i]; });
    if (tests.depth_write) for_each_pixel(pass, [&](std::size_t i) { depth[i] = z[i]; });
  }
  if (tests.stencil_test) {
    update_stencil(face.depth_fail, stencil_pass & ~pass, tests.stencil_ref, face.write_mask,
                   stencil);
    update_stencil(face.pass, pass, tests.stencil_ref, face.write_mask, stencil);
  }
  return pass;
}

void depth_range(const std::uint32_t* depth, std::uint32_t& least,
                 std::uint32_t& greatest) noexcept {
  const auto [low, high] = std::minmax_element(depth, depth + kPixelsPerBlock);
  least = *low;
  greatest = *high;
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
  static constexpr Kernels kKernels{cover_grid, test_block, depth_range, blend_block, transform};
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
