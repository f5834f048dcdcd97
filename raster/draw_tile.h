// A draw's triangles inside one 64x64 tile: which blocks each touches, which of those its depth
// decides as a whole, and the tests, stencil updates and colours of the rest.
#pragma once

#include <memory_resource>
#include <optional>

#include "raster/depth_decision.h"
#include "raster/frame.h"
#include "raster/geometry.h"
#include "raster/kernels.h"
#include "raster/tile_pixels.h"
#include "raster/tile_shading.h"
#include "raster/write_color.h"

namespace gnomon::raster {

/// What the fragments of one facing do, resolved once a draw.
struct FaceSetup {
  FragmentTests tests;
  /// A fragment that passes (or fails) the depth test can leave a mark in some buffer.
  bool pass_marks = false, fail_marks = false;
  DepthDecision decision{CompareFunc::always};
  /// Every fragment passes (or fails) the depth test, whatever the depths are.
  bool depth_always = true, depth_never = false;
  /// The stencil test lets some fragments through and the draw changes no stencil, so blocks can
  /// be sorted out beforehand.
  bool selects = false;
  /// Nothing but the depth test decides and the only mark is `delta`, added modulo 256 to the
  /// stencil of fragments that pass (count_on_pass) or fail it.
  bool counts = false, count_on_pass = false;
  std::uint8_t delta = 0;
};

/// What the fragments of a draw share, resolved once a draw.
struct FragmentSetup {
  FaceSetup front, back;
  /// Colour reaches a target.
  bool color = false;
  /// The colour of all fragments, if they have one.
  std::optional<glm::vec4> constant;
  /// How the vector kernel shades it, if it can.
  std::optional<DrawShading> shading;
  /// Fragments change nothing but colour.
  bool changes_color_only = false;
  /// The stencil is read, or written otherwise than by counts.
  bool uses_stencil = false;
};

/// `memory` outlives it.
FragmentSetup make_fragment_setup(const Draw& draw, const Targets& targets, const Kernels& kernels,
                                  std::pmr::memory_resource& memory);

/// A draw on its way through one tile.
class DrawInTile {
 public:
  /// Precondition: `pixels` uses the draw's targets.
  DrawInTile(const DrawSetup& setup, const FragmentSetup& fragments, TilePixels& pixels);

  /// No triangle can leave a mark in the tile.
  bool is_idle();
  /// The same of triangles that are not cut, all of them in the box of these eight corners.
  bool is_idle_in(const std::array<glm::vec4, 8>& corners) const;
  /// That can be true.
  bool selects_by_lookup() const { return lookup_ != nullptr; }

  /// Draws the triangle's pixels inside the tile. `source` is that of its chunk.
  void draw(const SetupTriangle& triangle, const TriangleSource& source) noexcept;

 private:
  void draw_any(const FaceSetup& face, const SetupTriangle& triangle, const TriangleSource& source);
  void draw_tiny(const FaceSetup& face, const SetupTriangle& triangle,
                 const TriangleSource& source);
  TestedBlocks tested_blocks(const FaceSetup& face) const;
  void test_pixels(const FaceSetup& face, const SetupTriangle& triangle,
                   const TriangleSource& source, bool has_plane, TestedBlocks& tested,
                   PixelMask* covered);
  static BlockMask marked(const FaceSetup& face, BlockMask blocks, const TestedBlocks& tested);
  void decide_tile(const FaceSetup& face, std::int32_t least, std::int32_t greatest,
                   TestedBlocks& tested) const;
  void decide_few(const DepthInterval& bounds, const FaceSetup& face, BlockMask blocks,
                  TestedBlocks& tested) const;
  void decide_blocks(const FaceSetup& face, const BlockDepths& depths, BlockMask blocks,
                     TestedBlocks& tested) const;
  BlockMask count_filled(const FaceSetup& face, BlockMask blocks, BlockMask filled,
                         const TestedBlocks& tested);
  BlockMask cover_blocks(const SetupTriangle& triangle, const TileEdges* edges, BlockMask blocks,
                         BlockMask filled, PixelMask* covered) const;
  void note_depths(const TileDepth& plane, BlockMask blocks, const PixelMask* written) const;
  void set_plane(const SetupTriangle& triangle, TestedBlocks& tested) const;
  BlockMask blocks_with_stencil(const FaceSetup& face);
  void color_blocks(const SetupTriangle& triangle, const TriangleSource& source, BlockMask blocks,
                    const PixelMask* passed) const;
  void shade_pixels(const SetupTriangle& triangle, const TriangleSource& source, std::size_t b,
                    PixelMask pixels, ColorPlanes& colors) const;

  const DrawSetup& setup_;
  const FragmentSetup& fragments_;
  TilePixels& pixels_;
  const Kernels& kernels_;
  /// The tile's first pixel.
  const int x0_, y0_;
  /// The blocks that lie wholly inside the draw's box.
  const BlockMask inside_;
  /// Triangles that it gives 0 all over need not be drawn; null if there is no such lookup.
  const FlatLookup* const lookup_;
  std::optional<BlockWriter> writer_;
  /// Blocks whose stencil lets a fragment of the front (back) through; computed when needed.
  std::optional<BlockMask> front_blocks_, back_blocks_;
};

}  // namespace gnomon::raster
