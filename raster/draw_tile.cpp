#include "raster/draw_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "raster/interpolate.h"

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

/// Fragments whose stencil test, or depth test, ends so change the stencil.
bool writes(const FragmentTests& tests, StencilOp op) {
  return tests.stencil_test && tests.stencil.write_mask != 0 && op != StencilOp::keep;
}

bool stencil_test_passes_all(const FragmentTests& tests) {
  return !tests.stencil_test || tests.stencil.func == CompareFunc::always;
}

bool writes_stencil(const FragmentTests& tests) {
  const StencilFace& face = tests.stencil;
  return writes(tests, face.pass) || (tests.depth_test && writes(tests, face.depth_fail)) ||
         (!stencil_test_passes_all(tests) && writes(tests, face.fail));
}

/// What op adds to a stencil, if that is all it does.
std::optional<std::uint8_t> added(const StencilFace& face, StencilOp op) {
  if (face.write_mask != 0xff) return std::nullopt;
  if (op == StencilOp::incr_wrap) return std::uint8_t{1};
  if (op == StencilOp::decr_wrap) return std::uint8_t{0xff};
  return std::nullopt;
}

FaceSetup make_face_setup(const FragmentTests& tests, bool color) {
  const StencilFace& stencil = tests.stencil;
  const bool passes_all = stencil_test_passes_all(tests);
  const bool fail_writes = !passes_all && writes(tests, stencil.fail);
  FaceSetup face;
  face.tests = tests;
  face.pass_marks = fail_writes || color || (tests.depth_test && tests.depth_write) ||
                    writes(tests, stencil.pass);
  face.fail_marks = fail_writes || writes(tests, stencil.depth_fail);
  face.decision = DepthDecision(tests.depth_func);
  face.depth_always = !tests.depth_test || tests.depth_func == CompareFunc::always;
  face.depth_never = tests.depth_test && tests.depth_func == CompareFunc::never;
  if (!passes_all || !tests.depth_test || tests.depth_write || color ||
      face.pass_marks == face.fail_marks)
    return face;
  const auto delta = added(stencil, face.pass_marks ? stencil.pass : stencil.depth_fail);
  face.counts = delta.has_value();
  face.count_on_pass = face.pass_marks;
  face.delta = delta.value_or(0);
  return face;
}

/// An edge at the tile's first pixel centre, over 256: a pixel's step is then the edge's a or b,
/// and the sign is exact, because all pixel centres of an edge are equal modulo 256.
struct TileEdge {
  std::int64_t value, a, b;

  std::int64_t greatest(int x, int y, int span) const {
    return value + x * a + y * b +
           (std::max<std::int64_t>(a, 0) + std::max<std::int64_t>(b, 0)) * span;
  }
  std::int64_t least(int x, int y, int span) const {
    return value + x * a + y * b +
           (std::min<std::int64_t>(a, 0) + std::min<std::int64_t>(b, 0)) * span;
  }
};

TileEdge edge_at_tile(const SetupTriangle& triangle, int k, int x0, int y0) {
  const Edge edge = triangle.edge(k);
  const std::int64_t value = edge.at(x0 * std::int64_t{256} + 128, y0 * std::int64_t{256} + 128);
  return {(value - edge.bias()) >> 8, edge.a, edge.b};
}

enum class Cover { none, in_32_bits, in_64_bits };

/// The edges that cross the tile. The guard band keeps them within 32 bits; only a vertex whose w
/// was rounded in a cut (raster/clip.h) can lie farther out.
Cover cross_tile(const SetupTriangle& triangle, int x0, int y0, TileEdges& edges) {
  constexpr std::int64_t kSteepest = std::int64_t{1} << 25;
  Cover cover = Cover::in_32_bits;
  for (int k = 0; k < 3; ++k) {
    const TileEdge edge = edge_at_tile(triangle, k, x0, y0);
    // A small triangle's edges are all near enough for 32 bits and are not worth sorting out.
    if (!triangle.small) {
      if (edge.greatest(0, 0, kTileSize - 1) < 0) return Cover::none;
      if (edge.least(0, 0, kTileSize - 1) >= 0) continue;
      if (std::abs(edge.a) + std::abs(edge.b) >= kSteepest) cover = Cover::in_64_bits;
    }
    const int i = edges.count++;
    edges.value[i] = static_cast<std::int32_t>(edge.value);
    edges.step_x[i] = static_cast<std::int32_t>(edge.a);
    edges.step_y[i] = static_cast<std::int32_t>(edge.b);
  }
  return cover;
}

/// Kernels::cover_pixels for edges that do not fit 32 bits.
BlockMask cover_pixels_in_64_bits(const SetupTriangle& triangle, int x0, int y0, BlockMask blocks,
                                  PixelMask* covered) {
  std::array<TileEdge, 3> edges{};
  for (int k = 0; k < 3; ++k)
    edges[static_cast<std::size_t>(k)] = edge_at_tile(triangle, k, x0, y0);
  BlockMask touched = 0;
  for_each_block_of(blocks, [&](std::size_t b) {
    covered[b] = 0;
    for (int i = 0; i < kPixelsPerBlock; ++i) {
      const int x = block_x(b) + i % kBlockSize, y = block_y(b) + i / kBlockSize;
      if (std::all_of(edges.begin(), edges.end(),
                      [&](const TileEdge& edge) { return edge.least(x, y, 0) >= 0; }))
        covered[b] |= PixelMask{1} << i;
    }
    if (covered[b]) touched |= BlockMask{1} << b;
  });
  return touched;
}

/// The blocks of a tile that a box in its pixels touches.
struct BoxBlocks {
  BlockMask mask;
  int count;
};

BoxBlocks blocks_of(const PixelBox& box) {
  const int x0 = box.x0 / kBlockSize, y0 = box.y0 / kBlockSize;
  const int width = (box.x1 - 1) / kBlockSize + 1 - x0, height = (box.y1 - 1) / kBlockSize + 1 - y0;
  const BlockMask row = (0xffu >> (8 - width)) << x0;
  const BlockMask rows = ~BlockMask{0} >> (64 - 8 * height) << 8 * y0;
  return {row * 0x0101010101010101u & rows, width * height};
}

/// The blocks of the tile at (x0, y0) that lie wholly in a box of the target's pixels.
BlockMask blocks_inside(const PixelBox& box, int x0, int y0) {
  const auto first = [](int pixel) {
    return (std::max(pixel, 0) + kBlockSize - 1) / kBlockSize * kBlockSize;
  };
  const auto end = [](int pixel) {
    return std::clamp(pixel, 0, kTileSize) / kBlockSize * kBlockSize;
  };
  const PixelBox whole = {first(box.x0 - x0), first(box.y0 - y0), end(box.x1 - x0),
                          end(box.y1 - y0)};
  return whole.empty() ? 0 : blocks_of(whole).mask;
}

/// A triangle that touches no more blocks than these is drawn without looking at its edges and its
/// plane over the tile first.
constexpr int kFewBlocks = 4;

}  // namespace

FragmentSetup make_fragment_setup(const Draw& draw, const Targets& targets, const Kernels& kernels,
                                  std::pmr::memory_resource& memory) {
  FragmentSetup setup;
  setup.color = targets.color && any(draw.state.color.write);
  setup.front = make_face_setup(resolve_tests(draw, targets, true), setup.color);
  setup.back = make_face_setup(resolve_tests(draw, targets, false), setup.color);
  bool keeps_stencil = true, keeps_depth = true;
  for (const FaceSetup* face : {&setup.front, &setup.back}) {
    keeps_depth = keeps_depth && !face->tests.depth_write;
    const bool changes = writes_stencil(face->tests);
    keeps_stencil = keeps_stencil && !changes;
    setup.uses_stencil =
        setup.uses_stencil || !stencil_test_passes_all(face->tests) || (changes && !face->counts);
  }
  for (FaceSetup* face : {&setup.front, &setup.back})
    face->selects = keeps_stencil && !stencil_test_passes_all(face->tests);
  if (!setup.color) return setup;
  setup.changes_color_only = keeps_depth && keeps_stencil;
  if (is_constant(draw))
    setup.constant = shade(draw.shading, Fragment{});
  else
    setup.shading = make_draw_shading(draw, targets, kernels, memory);
  return setup;
}

DrawInTile::DrawInTile(const DrawSetup& setup, const FragmentSetup& fragments, TilePixels& pixels)
    : setup_(setup),
      fragments_(fragments),
      pixels_(pixels),
      kernels_(pixels.kernels()),
      x0_(pixels.tile().x * kTileSize),
      y0_(pixels.tile().y * kTileSize),
      inside_(blocks_inside(setup.box, x0_, y0_)),
      lookup_(fragments.changes_color_only && fragments.shading && fragments.shading->lookup &&
                      !fragments.shading->lookup->ranges.empty()
                  ? &*fragments.shading->lookup
                  : nullptr) {
  if (fragments.uses_stencil) pixels_.add_counts();
  if (fragments.color)
    writer_.emplace(kernels_, *pixels.targets().color, pixels.tile(), setup.draw->state.color);
}

void DrawInTile::set_plane(const SetupTriangle& triangle, TestedBlocks& tested) const {
  TileDepth& plane = tested.plane;
  plane.fraction_bits = depth_fraction_bits(setup_.depth_format);
  const bool first_tile = triangle.x0 >= x0_ && triangle.y0 >= y0_;
  const std::uint64_t base = triangle.has_base && first_tile
                                 ? triangle.base
                                 : depth_base_at(triangle.vertices, triangle.area(), x0_, y0_);
  plane.base = base + (std::uint64_t{1} << (plane.fraction_bits - 1));
  plane.step_x = triangle.step_x;
  plane.step_y = triangle.step_y;
  plane.narrow = triangle.narrow;
  plane.low = setup_.depth_low;
  plane.high = setup_.depth_high;
}

/// Those of the blocks that can still be marked.
BlockMask DrawInTile::marked(const FaceSetup& face, BlockMask blocks, const TestedBlocks& tested) {
  if (!face.pass_marks) blocks &= ~tested.depth_passes;
  if (!face.fail_marks) blocks &= ~tested.depth_fails;
  return blocks;
}

/// Decides the depth test for the whole tile by bounds of the triangle's depths.
void DrawInTile::decide_tile(const FaceSetup& face, std::int32_t least, std::int32_t greatest,
                             TestedBlocks& tested) const {
  // Where depths are written the tile's range would have to be found again and again.
  if (face.tests.depth_write) return;
  pixels_.know_whole_range();
  const DepthRanges& ranges = pixels_.ranges();
  switch (face.decision.of(least, greatest, ranges.whole_least, ranges.whole_greatest)) {
    case DepthOutcome::passes:
      tested.depth_passes = kAllBlocks;
      break;
    case DepthOutcome::fails:
      tested.depth_fails = kAllBlocks;
      break;
    case DepthOutcome::open:
      break;
  }
}

/// The same block by block, for a few by the vertices alone and where a range is known: to find one
/// costs as much as to test the block.
void DrawInTile::decide_few(const DepthInterval& bounds, const FaceSetup& face, BlockMask blocks,
                            TestedBlocks& tested) const {
  const DepthRanges& ranges = pixels_.ranges();
  for_each_block_of(blocks & ranges.known, [&](std::size_t b) {
    const DepthOutcome outcome =
        face.decision.of(bounds.least, bounds.greatest, ranges.least[b], ranges.greatest[b]);
    if (outcome == DepthOutcome::passes) tested.depth_passes |= BlockMask{1} << b;
    if (outcome == DepthOutcome::fails) tested.depth_fails |= BlockMask{1} << b;
  });
}

void DrawInTile::decide_blocks(const FaceSetup& face, const BlockDepths& depths, BlockMask blocks,
                               TestedBlocks& tested) const {
  pixels_.know_ranges(blocks);
  const DepthRanges& ranges = pixels_.ranges();
  face.decision.settle(
      kernels_.compare_ranges(depths, ranges.least.data(), ranges.greatest.data(),
                              face.decision.below_slack, face.decision.above_slack),
      tested);
}

BlockMask DrawInTile::blocks_with_stencil(const FaceSetup& face) {
  std::optional<BlockMask>& blocks = &face == &fragments_.front ? front_blocks_ : back_blocks_;
  if (!blocks) blocks = kernels_.stencil_blocks(face.tests, pixels_.stencil());
  return *blocks;
}

bool DrawInTile::is_idle() {
  const auto idle = [&](const FaceSetup& face) {
    return (!face.pass_marks && !face.fail_marks) || (face.selects && !blocks_with_stencil(face));
  };
  return idle(fragments_.front) && idle(fragments_.back);
}

bool DrawInTile::is_idle_in(const std::array<glm::vec4, 8>& corners) const {
  constexpr std::uint32_t kCorners[] = {0, 1, 2, 3, 4, 5, 6, 7};
  return lookup_ && lookup_->leaves_no_mark(kernels_, corners.data(), kCorners, 8);
}

void DrawInTile::draw(const SetupTriangle& triangle, const TriangleSource& source) noexcept {
  const FaceSetup& face = triangle.front_facing ? fragments_.front : fragments_.back;
  const MeshView& mesh = setup_.draw->mesh;
  if (lookup_ && triangle.piece == SetupTriangle::kWhole &&
      lookup_->leaves_no_mark(kernels_, mesh.positions.data(), &mesh.indices[triangle.first_index],
                              3))
    return;
  // What the front end found out about its pixels holds where none of them lies in another tile.
  if (triangle.pixels && triangle.x0 >= x0_ && triangle.y0 >= y0_ &&
      triangle.x1 <= x0_ + kTileSize && triangle.y1 <= y0_ + kTileSize)
    draw_tiny(face, triangle, source);
  else
    draw_any(face, triangle, source);
}

/// Draws a triangle of any size.
void DrawInTile::draw_any(const FaceSetup& face, const SetupTriangle& triangle,
                          const TriangleSource& source) {
  const PixelBox box = {std::max(triangle.x0 - x0_, 0), std::max(triangle.y0 - y0_, 0),
                        std::min(triangle.x1 - x0_, kTileSize),
                        std::min(triangle.y1 - y0_, kTileSize)};
  if (box.empty()) return;
  const BoxBlocks near = blocks_of(box);
  const bool few = near.count <= kFewBlocks;
  BlockMask blocks = near.mask;
  if (face.selects) blocks &= blocks_with_stencil(face);

  TestedBlocks tested = tested_blocks(face);
  const bool compares = !face.depth_always && !face.depth_never;
  const DepthInterval bounds = compares ? vertex_depths(triangle, setup_) : DepthInterval{};
  if (compares) decide_tile(face, bounds.least, bounds.greatest, tested);
  blocks = marked(face, blocks, tested);
  if (!blocks) return;

  TileEdges edges;
  const Cover cover = cross_tile(triangle, x0_, y0_, edges);
  if (cover == Cover::none) return;
  edges.first_row = box.y0;
  edges.end_row = box.y1;
  const auto is_open = [&] { return !(tested.depth_passes | tested.depth_fails); };
  BlockDepths depths;
  bool has_plane = false;
  if (!few && compares && is_open()) {
    set_plane(triangle, tested);
    has_plane = true;
    depths = bound_plane(tested.plane, bounds.least, bounds.greatest);
    const DepthInterval inside = bounds_in_box(tested.plane, depths, box);
    decide_tile(face, inside.least, inside.greatest, tested);
    blocks = marked(face, blocks, tested);
    if (!blocks) return;
  }
  BlockMask filled = edges.count == 0 ? kAllBlocks : 0;
  if (!few && edges.count > 0 && cover == Cover::in_32_bits)
    blocks &= kernels_.cover_blocks(edges, filled);
  if (compares && is_open() && blocks) {
    if (few)
      decide_few(bounds, face, blocks, tested);
    else
      decide_blocks(face, depths, blocks, tested);
    blocks = marked(face, blocks, tested);
  }
  if (face.counts) blocks = count_filled(face, blocks, filled, tested);
  if (!blocks) return;
  std::array<PixelMask, kBlocksPerTile> covered;
  tested.blocks = cover_blocks(triangle, cover == Cover::in_32_bits ? &edges : nullptr, blocks,
                               filled, covered.data());
  if (tested.blocks) test_pixels(face, triangle, source, has_plane, tested, covered.data());
}

/// Draws a triangle whose pixels are known and lie in the tile.
void DrawInTile::draw_tiny(const FaceSetup& face, const SetupTriangle& triangle,
                           const TriangleSource& source) {
  TestedBlocks tested = tested_blocks(face);
  const bool compares = !face.depth_always && !face.depth_never;
  const DepthInterval bounds = compares ? vertex_depths(triangle, setup_) : DepthInterval{};
  if (compares) decide_tile(face, bounds.least, bounds.greatest, tested);
  const BlockMask open =
      marked(face, face.selects ? blocks_with_stencil(face) : kAllBlocks, tested);
  if (!open) return;
  std::array<PixelMask, kBlocksPerTile> covered;
  for_each_block(triangle.pixels, triangle.x0 - x0_, triangle.y0 - y0_,
                 [&](std::size_t b, PixelMask pixels) {
                   covered[b] = pixels;
                   tested.blocks |= BlockMask{1} << b;
                 });
  tested.blocks &= open;
  if (compares && !(tested.depth_passes | tested.depth_fails)) {
    decide_few(bounds, face, tested.blocks, tested);
    tested.blocks = marked(face, tested.blocks, tested);
  }
  if (tested.blocks) test_pixels(face, triangle, source, false, tested, covered.data());
}

/// What is known of the depth test before a triangle is looked at.
TestedBlocks DrawInTile::tested_blocks(const FaceSetup& face) const {
  return {.depth_passes = face.depth_always ? kAllBlocks : 0,
          .depth_fails = face.depth_never ? kAllBlocks : 0,
          .depth = pixels_.depth(),
          .stencil = pixels_.stencil()};
}

/// Tests the covered pixels of the blocks, which are some, and marks what they mark.
void DrawInTile::test_pixels(const FaceSetup& face, const SetupTriangle& triangle,
                             const TriangleSource& source, bool has_plane, TestedBlocks& tested,
                             PixelMask* covered) {
  const bool needs_plane =
      face.tests.depth_test && (face.tests.depth_write ||
                                (tested.blocks & ~(tested.depth_passes | tested.depth_fails)) != 0);
  if (needs_plane && !has_plane) set_plane(triangle, tested);
  if (face.counts) {
    kernels_.count_blocks(face.tests.depth_func, face.count_on_pass, face.delta, tested, covered);
    return;
  }
  const BlockMask passed = kernels_.test_blocks(face.tests, tested, covered);
  if (face.tests.depth_test && face.tests.depth_write) note_depths(tested.plane, passed, covered);
  if (fragments_.color) color_blocks(triangle, source, passed, covered);
}

/// Keeps the ranges true after the pixels of the blocks got the plane's depths.
void DrawInTile::note_depths(const TileDepth& plane, BlockMask blocks,
                             const PixelMask* written) const {
  DepthRanges& ranges = pixels_.ranges();
  for_each_block_of(blocks, [&](std::size_t b) {
    if (written[b] != kAllPixels) {
      ranges.forget(b);
      return;
    }
    const DepthInterval depths = depths_of_block(plane, b);
    ranges.set(b, static_cast<std::uint32_t>(depths.least),
               static_cast<std::uint32_t>(depths.greatest));
  });
}

/// Counts the blocks that the triangle fills and marks as a whole, and returns the others.
BlockMask DrawInTile::count_filled(const FaceSetup& face, BlockMask blocks, BlockMask filled,
                                   const TestedBlocks& tested) {
  const BlockMask counted =
      blocks & filled & inside_ & (face.count_on_pass ? tested.depth_passes : tested.depth_fails);
  if (counted) pixels_.count(counted, face.delta);
  return blocks & ~counted;
}

/// The pixels that the triangle covers in each of the blocks; `edges` is null if they do not fit 32
/// bits. Returns the blocks where there are some.
BlockMask DrawInTile::cover_blocks(const SetupTriangle& triangle, const TileEdges* edges,
                                   BlockMask blocks, BlockMask filled, PixelMask* covered) const {
  for_each_block_of(blocks & filled, [&](std::size_t b) { covered[b] = kAllPixels; });
  const BlockMask crossed = blocks & ~filled;
  if (crossed)
    blocks =
        (blocks & filled) | (edges ? kernels_.cover_pixels(*edges, crossed, covered)
                                   : cover_pixels_in_64_bits(triangle, x0_, y0_, crossed, covered));
  for_each_block_of(blocks & ~inside_, [&](std::size_t b) {
    covered[b] &= box_mask(setup_.box, x0_ + block_x(b), y0_ + block_y(b));
    if (!covered[b]) blocks &= ~(BlockMask{1} << b);
  });
  return blocks;
}

void DrawInTile::color_blocks(const SetupTriangle& triangle, const TriangleSource& source,
                              BlockMask blocks, const PixelMask* passed) const {
  const Draw& draw = *setup_.draw;
  if (!blocks) return;
  if (fragments_.constant) {
    for_each_block_of(blocks,
                      [&](std::size_t b) { writer_->write(b, passed[b], *fragments_.constant); });
    return;
  }
  if (fragments_.shading && kernels_.shade_and_store) {
    const TileShading shading =
        make_tile_shading(draw, *fragments_.shading, triangle, source, x0_, y0_);
    kernels_.shade_and_store(shading, blocks, passed, writer_->tile());
    return;
  }
  for_each_block_of(blocks, [&](std::size_t b) {
    ColorPlanes colors;
    shade_pixels(triangle, source, b, passed[b], colors);
    writer_->write(b, passed[b], colors);
  });
}

/// The colours of block b pixel by pixel.
void DrawInTile::shade_pixels(const SetupTriangle& triangle, const TriangleSource& source,
                              std::size_t b, PixelMask pixels, ColorPlanes& colors) const {
  const Draw& draw = *setup_.draw;
  const int x = x0_ + block_x(b), y = y0_ + block_y(b);
  for_each_pixel(pixels, [&](std::size_t i) {
    const int px = x + static_cast<int>(i) % kBlockSize, py = y + static_cast<int>(i) / kBlockSize;
    set_color(colors, i, shade(draw.shading, interpolate(draw, triangle, source, px, py)));
  });
}

}  // namespace gnomon::raster
