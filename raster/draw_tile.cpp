#include "raster/draw_tile.h"

#include <algorithm>
#include <cmath>

#include "raster/interpolate.h"
#include "raster/write_color.h"

namespace gnomon::raster {

namespace {

/// The draw's fragments all have one colour.
bool is_constant(const Draw& draw) {
  const Flat* flat = std::get_if<Flat>(&draw.shading);
  return flat && !flat->texture && !flat->depth_lookup && draw.mesh.colors.empty();
}

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

/// An edge at the tile's first pixel centre, over 256: a pixel's step is then the edge's a or b,
/// and the sign is exact, because all pixel centres of an edge are equal modulo 256.
struct TileEdge {
  std::int64_t value = 0, a = 0, b = 0;

  std::int64_t at(int x, int y) const { return value + x * a + y * b; }
  /// Over the pixels from (x, y) to (x + span, y + span).
  std::int64_t greatest(int x, int y, int span) const {
    return at(x, y) + (std::max<std::int64_t>(a, 0) + std::max<std::int64_t>(b, 0)) * span;
  }
  std::int64_t least(int x, int y, int span) const {
    return at(x, y) + (std::min<std::int64_t>(a, 0) + std::min<std::int64_t>(b, 0)) * span;
  }
};

/// The edges that cross a tile, and which of its 64 blocks the triangle touches and fills (bit 8 y
/// + x). `touched` may have blocks too many, `filled` some too few.
struct TileCover {
  std::array<TileEdge, 3> edges;
  int count = 0;
  PixelMask touched = kAllPixels, filled = kAllPixels;
};

void add_edge(GridEdges& grid, const TileEdge& edge, bool greatest) {
  constexpr int kSpan = kBlockSize - 1;
  const auto k = grid.count++;
  grid.value[k] =
      static_cast<std::int32_t>(greatest ? edge.greatest(0, 0, kSpan) : edge.least(0, 0, kSpan));
  grid.step_x[k] = static_cast<std::int32_t>(edge.a * kBlockSize);
  grid.step_y[k] = static_cast<std::int32_t>(edge.b * kBlockSize);
}

TileCover cover_tile(const SetupTriangle& triangle, TileIndex tile, const Kernels& kernels) {
  constexpr int kSpan = kTileSize - 1;
  // Then a crossing edge is within 63 (|a| + |b|) < 2^31 of zero all over the tile.
  constexpr std::int64_t kSteepest = std::int64_t{1} << 25;
  TileCover cover;
  GridEdges touching, filling;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const std::int64_t value = triangle.edge(k, tile.x * std::int64_t{kTileSize * 256} + 128,
                                             tile.y * std::int64_t{kTileSize * 256} + 128);
    const TileEdge edge{(value - triangle.bias[i]) >> 8, triangle.a[i], triangle.b[i]};
    if (edge.least(0, 0, kSpan) >= 0) continue;
    cover.edges[static_cast<std::size_t>(cover.count++)] = edge;
    if (std::abs(edge.a) + std::abs(edge.b) < kSteepest) {
      add_edge(touching, edge, true);
      add_edge(filling, edge, false);
    } else {
      cover.filled = 0;
    }
  }
  if (touching.count > 0) {
    cover.touched = kernels.cover_grid(touching);
    cover.filled &= kernels.cover_grid(filling);
  }
  return cover;
}

/// The pixels of a block that lie inside the edges.
PixelMask cover_block(const TileCover& cover, int x, int y, const Kernels& kernels) {
  constexpr int kSpan = kBlockSize - 1;
  GridEdges grid;
  for (int k = 0; k < cover.count; ++k) {
    const TileEdge& edge = cover.edges[static_cast<std::size_t>(k)];
    if (edge.greatest(x, y, kSpan) < 0) return 0;
    if (edge.least(x, y, kSpan) >= 0) continue;
    // It crosses the block, so it is within 7 (|a| + |b|) < 2^29 of zero in it.
    grid.value[grid.count] = static_cast<std::int32_t>(edge.at(x, y));
    grid.step_x[grid.count] = static_cast<std::int32_t>(edge.a);
    grid.step_y[grid.count] = static_cast<std::int32_t>(edge.b);
    ++grid.count;
  }
  return grid.count > 0 ? kernels.cover_grid(grid) : kAllPixels;
}

/// `always` or `never` if the ranges decide the comparison for every pair of their depths.
CompareFunc decided(CompareFunc func, const DepthRangeUnits& fragment,
                    const DepthRangeUnits& stored) {
  const auto decide = [func](bool always, bool never) {
    return always ? CompareFunc::always : never ? CompareFunc::never : func;
  };
  const bool apart = fragment.greatest < stored.least || fragment.least > stored.greatest;
  const bool one = fragment.least == fragment.greatest && stored.least == stored.greatest &&
                   fragment.least == stored.least;
  switch (func) {
    case CompareFunc::less:
      return decide(fragment.greatest < stored.least, fragment.least >= stored.greatest);
    case CompareFunc::less_equal:
      return decide(fragment.greatest <= stored.least, fragment.least > stored.greatest);
    case CompareFunc::greater:
      return decide(fragment.least > stored.greatest, fragment.greatest <= stored.least);
    case CompareFunc::greater_equal:
      return decide(fragment.least >= stored.greatest, fragment.greatest < stored.least);
    case CompareFunc::equal:
      return decide(one, apart);
    case CompareFunc::not_equal:
      return decide(apart, one);
    case CompareFunc::never:
    case CompareFunc::always:
      break;
  }
  return func;
}

/// Some fragment whose depth test ends so can leave a mark.
bool leaves_a_mark(const FragmentTests& tests, bool color, bool depth_passes) {
  if (depth_passes && (color || (tests.depth_test && tests.depth_write))) return true;
  if (!tests.stencil_test || tests.stencil.write_mask == 0) return false;
  const StencilFace& face = tests.stencil;
  const StencilOp op = depth_passes ? face.pass : face.depth_fail;
  return op != StencilOp::keep ||
         (face.func != CompareFunc::always && face.fail != StencilOp::keep);
}

class TriangleInTile {
 public:
  TriangleInTile(const Kernels& kernels, const DrawSetup& setup, const FragmentSetup& fragments,
                 const SetupTriangle& triangle, const Targets& targets, TileIndex tile,
                 BlockRanges& ranges)
      : kernels_(kernels),
        setup_(setup),
        fragments_(fragments),
        triangle_(triangle),
        targets_(targets),
        tile_(tile),
        ranges_(ranges),
        tests_(triangle.front_facing ? fragments.front : fragments.back),
        pass_marks_(leaves_a_mark(tests_, fragments.color, true)),
        fail_marks_(leaves_a_mark(tests_, fragments.color, false)),
        depth_(targets.depth ? targets.depth->plane().tile(tile.x, tile.y) : nullptr),
        stencil_(targets.stencil ? targets.stencil->plane().tile(tile.x, tile.y) : nullptr) {}

  void draw() {
    const PixelBox box = intersect(triangle_.box, tile_box(tile_));
    if (box.empty()) return;
    const TileCover cover = cover_tile(triangle_, tile_, kernels_);
    const int x0 = tile_.x * kTileSize, y0 = tile_.y * kTileSize;
    const PixelBox blocks{(box.x0 - x0) / kBlockSize, (box.y0 - y0) / kBlockSize,
                          (box.x1 - 1 - x0) / kBlockSize + 1, (box.y1 - 1 - y0) / kBlockSize + 1};
    for_each_pixel(cover.touched & box_mask(blocks, 0, 0), [&](std::size_t block) {
      draw_block(cover, block, (cover.filled >> block & 1) != 0);
    });
  }

 private:
  void draw_block(const TileCover& cover, std::size_t block, bool filled) {
    const int x = static_cast<int>(block) % kBlocksPerTileRow * kBlockSize;
    const int y = static_cast<int>(block) / kBlocksPerTileRow * kBlockSize;
    const std::size_t offset = block * kPixelsPerBlock;
    FragmentTests tests = tests_;
    if (tests.depth_test) {
      if (tests.depth_func != CompareFunc::always && tests.depth_func != CompareFunc::never)
        tests.depth_func = decided(tests.depth_func, fragment_range(x, y),
                                   ranges_.of(block, depth_ + offset, kernels_));
      if (tests.depth_func == CompareFunc::always && !pass_marks_) return;
      if (tests.depth_func == CompareFunc::never && !fail_marks_) return;
    }
    PixelMask covered = filled ? kAllPixels : cover_block(cover, x, y, kernels_);
    covered &= box_mask(setup_.box, tile_.x * kTileSize + x, tile_.y * kTileSize + y);
    if (!covered) return;
    BlockDepth plane;
    if (tests.depth_test) {
      plane = plane_at_tile();
      plane.base += static_cast<std::uint64_t>(x) * plane.step_x +
                    static_cast<std::uint64_t>(y) * plane.step_y;
    }
    const PixelMask passed =
        kernels_.test_block(tests, covered, plane, depth_ ? depth_ + offset : nullptr,
                            stencil_ ? stencil_ + offset : nullptr);
    if (!passed) return;
    if (tests.depth_test && tests.depth_write) ranges_.forget(block);
    if (fragments_.color) color_block(passed, x, y, offset);
  }

  const BlockDepth& plane_at_tile() {
    if (!plane_) plane_ = depth_at_tile(setup_, triangle_.depth, tile_);
    return *plane_;
  }

  /// Encloses the depths of the triangle's fragments in the block at (x, y) of the tile.
  DepthRangeUnits fragment_range(int x, int y) const {
    const auto [least, greatest] = triangle_.depth.range(
        tile_.x * kTileSize + x, tile_.y * kTileSize + y, kBlockSize - 1, setup_.depth_format);
    const double low = setup_.depth_low, high = setup_.depth_high;
    return {static_cast<std::uint32_t>(std::clamp(least, low, high)),
            static_cast<std::uint32_t>(std::clamp(greatest, low, high))};
  }

  void color_block(PixelMask passed, int x, int y, std::size_t offset) const {
    const Draw& draw = *setup_.draw;
    if (fragments_.constant) {
      write_constant(kernels_, *targets_.color, tile_, offset, draw.state.color, passed,
                     *fragments_.constant);
      return;
    }
    write_block(kernels_, *targets_.color, tile_, offset, draw.state.color, passed,
                [&](std::size_t i) {
                  const int px = tile_.x * kTileSize + x + static_cast<int>(i) % kBlockSize,
                            py = tile_.y * kTileSize + y + static_cast<int>(i) / kBlockSize;
                  return shade(draw.shading, interpolate(draw, triangle_, px, py));
                });
  }

  const Kernels& kernels_;
  const DrawSetup& setup_;
  const FragmentSetup& fragments_;
  const SetupTriangle& triangle_;
  const Targets& targets_;
  const TileIndex tile_;
  BlockRanges& ranges_;
  const FragmentTests& tests_;
  const bool pass_marks_, fail_marks_;
  std::uint32_t* const depth_;
  std::uint8_t* const stencil_;
  std::optional<BlockDepth> plane_;
};

}  // namespace

FragmentSetup make_fragment_setup(const Draw& draw, const Targets& targets) {
  FragmentSetup setup;
  setup.front = resolve_tests(draw, targets, true);
  setup.back = resolve_tests(draw, targets, false);
  setup.color = targets.color && any(draw.state.color.write);
  if (setup.color && is_constant(draw)) setup.constant = shade(draw.shading, Fragment{});
  return setup;
}

void draw_tile(const Kernels& kernels, const DrawSetup& setup, const FragmentSetup& fragments,
               const SetupTriangle& triangle, const Targets& targets, TileIndex tile,
               BlockRanges& ranges) noexcept {
  TriangleInTile(kernels, setup, fragments, triangle, targets, tile, ranges).draw();
}

}  // namespace gnomon::raster
