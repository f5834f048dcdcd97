// The kernel boundary: the front end's loops over vertices and triangles, and what happens to the
// pixels of a 64x64 tile, in 8x8 blocks of 64. A tile's tests and counts are integer; a set of
// pixels is a 64-bit mask, bit 8 y + x for pixel (x, y) of the block, and planes are block-linear
// (raster/tiled_plane.h). Kernels cannot fail. They are written twice: in plain C++
// (kernels_scalar.cpp) and once for all vector instruction sets (kernels_simd.cpp); both leave the
// same bytes.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "raster/isa.h"
#include "raster/project.h"
#include "raster/select_triangles.h"
#include "raster/state.h"

namespace gnomon::raster {

using PixelMask = std::uint64_t;
inline constexpr PixelMask kAllPixels = ~PixelMask{0};

/// Calls body(i) for each bit i of the mask, lowest first.
template <class Body>
void for_each_bit(std::uint64_t mask, Body body) {
  for (; mask; mask &= mask - 1) body(static_cast<std::size_t>(__builtin_ctzll(mask)));
}

/// The same for the pixels of a mask.
template <class Body>
void for_each_pixel(PixelMask mask, Body body) {
  for_each_bit(mask, body);
}

/// A set of the 8x8 blocks of a tile, bit 8 y + x for block (x, y).
using BlockMask = std::uint64_t;
inline constexpr BlockMask kAllBlocks = ~BlockMask{0};

/// Calls body(b) for each block of the mask, lowest bit first.
template <class Body>
void for_each_block_of(BlockMask mask, Body body) {
  for_each_bit(mask, body);
}

/// The edges of a triangle that cross a tile, as 32-bit sums: value + x * step_x + y * step_y at
/// pixel (x, y) of the tile, not negative inside. Edges that hold everywhere are left out. Sums do
/// not overflow in the tile, because |step_x| + |step_y| < 2^25.
struct TileEdges {
  int count = 0;
  std::int32_t value[3];
  std::int32_t step_x[3], step_y[3];
  /// The rows of the tile that are asked for; of others cover_pixels may say anything.
  int first_row = 0, end_row = 64;
};

/// A depth plane at a tile's first pixel, half a unit added (raster/depth_plane.h).
struct TileDepth {
  std::uint64_t base = 0, step_x = 0, step_y = 0;
  int fraction_bits = 8;
  bool narrow = true;
  std::uint32_t low = 0, high = 0xffffff;
};

/// Bounds of a triangle's depths in the blocks of a tile, in depth units: in block (x, y) they lie
/// between low + x * low_step_x + y * low_step_y and the same of high, and everywhere between least
/// and greatest.
struct BlockDepths {
  std::int32_t low = 0, low_step_x = 0, low_step_y = 0;
  std::int32_t high = 0, high_step_x = 0, high_step_y = 0;
  std::int32_t least = 0, greatest = 0xffffff;
};

/// Blocks in which all of a triangle's depths are below, or above, all that are stored.
struct DecidedBlocks {
  BlockMask below = 0, above = 0;
};

/// Depth and stencil state of one draw and facing, resolved against the targets that are there.
struct FragmentTests {
  bool depth_test = false, depth_write = false, stencil_test = false;
  CompareFunc depth_func = CompareFunc::always;
  StencilFace stencil;
  std::uint8_t stencil_ref = 0;
};

/// The blocks of a tile that a triangle's fragments are tested in.
struct TestedBlocks {
  /// All of them; of those the ones whose fragments all pass, or all fail, the depth test.
  BlockMask blocks = 0, depth_passes = 0, depth_fails = 0;
  TileDepth plane = {};
  /// The tile's 64 blocks of 64 values each; null if the test that wants them is off.
  std::uint32_t* depth = nullptr;
  std::uint8_t* stencil = nullptr;
};

/// A triangle's weights over a tile: edges at the tile's first pixel and their steps a pixel, all
/// of them whole numbers below 2^53, and what they are multiplied by (raster/interpolate.h).
struct TileWeights {
  double edge[3], step_x[3], step_y[3];
  double scale[3];
  /// Weights of the mesh triangle's vertices are rows [vertex of the piece][vertex of the mesh];
  /// unless it is a piece, they are the three weights in this order.
  bool is_piece;
  double piece[3][3];
  int order[3];
};

/// A depth lookup as the vector kernel wants it (raster/depth_lookup.h).
struct LookupTerms {
  float map_from_position[4][4];
  /// The map's values, tile by tile (raster/tiled_plane.h), in units of which `units` - 1 are 1.0.
  const std::uint32_t* texels;
  int width, height, tiles_x;
  float units;
  CompareFunc func;
  bool linear;
  /// Texels outside the map have depth `border`, in [0, 1], and not that of the map's edge.
  bool has_border;
  float border;
};

/// The least and the greatest depth in an 8x8 block of a map.
struct LookupRange {
  std::uint32_t least, greatest;
};

/// A lookup with the ranges of its map's blocks, row after row.
struct LookupBounds {
  const LookupTerms* lookup;
  const LookupRange* blocks;
  int blocks_x;
};

/// A light as the vector kernel wants it; names and units are those of raster::Light.
struct LitLight {
  float position[4];
  float ambient[3], diffuse[3], specular[3];
  float attenuation[3];
  /// The attenuation is 1, 0, 0.
  bool keeps_strength;
  /// Adding the ambient term can change a colour.
  bool ambient_matters;
  float spot_direction[3];
  float spot_cos_cutoff;
  int spot_exponent;
  bool has_shadow_map;
  LookupTerms shadow_map;
};

/// Lighting without textures (raster/shading.h), the same for all blocks of a draw.
struct LitTerms {
  float material_ambient[3], material_diffuse[3], material_specular[3], material_emission[3];
  float material_alpha;
  int shininess;
  bool ambient, emission, diffuse, specular;
  /// The specular sum can change a bit of the result.
  bool specular_matters;
  /// Some light, its shadow map or the highlight depends on the fragment's place.
  bool world_matters;
  float scene_ambient[3], eye_world[3];
  float world_from_model[4][4], world_from_model_normal[3][3];
};

struct Lighting {
  const LitTerms* terms;
  const LitLight* lights;
  int light_count;
};

/// Attributes of vertices in a row that are lit; `colors` is null if the mesh has none.
struct LitAttributes {
  const glm::vec4* positions;
  const glm::vec3* normals;
  const glm::vec4* colors;
};

/// A triangle's colours over a tile: lit, or `flat_color` times the vertices' colours and the share
/// that a lookup gives.
struct TileShading {
  TileWeights weights;
  /// Without terms if it is flat.
  Lighting lighting;
  float flat_color[4];
  /// Of a flat colour, null if there is none; which channels it scales.
  const LookupTerms* lookup;
  bool lookup_scales_rgb, lookup_scales_alpha;
  /// A pixel for which the lookup's share is 0 keeps its colour.
  bool zero_share_keeps;
  /// Of the mesh triangle's three vertices.
  float normals[3][3], positions[3][4], colors[3][4];
  bool has_colors;
  bool reverse_normal;
};

/// The colours of a tile, block after block, and the state under which they are written.
struct ColorTile {
  /// Four bytes a pixel, or four floats; the other one is null.
  std::uint8_t* rgba8;
  float* rgba32f;
  const ColorState* state;
  /// The blend's constant colour in 8 bits.
  std::uint8_t constant[4];
};

/// The kernels of one instruction set. Arrays of masks have one entry a block of the tile.
struct Kernels {
  /// The blocks that no edge keeps out as a whole, and of those the ones inside all edges.
  BlockMask (*cover_blocks)(const TileEdges& edges, BlockMask& filled) noexcept;

  /// covered[b] = the pixels of block b inside all edges, for each b of `blocks`; returns the
  /// blocks where there are some.
  BlockMask (*cover_pixels)(const TileEdges& edges, BlockMask blocks, PixelMask* covered) noexcept;

  /// Compares a triangle's depths, block by block, with the least and greatest of those stored: a
  /// block is `below` if high < least[b] + below_slack, `above` if low > greatest[b] - above_slack.
  DecidedBlocks (*compare_ranges)(const BlockDepths& depths, const std::uint32_t* least,
                                  const std::uint32_t* greatest, std::int32_t below_slack,
                                  std::int32_t above_slack) noexcept;

  /// Runs stencil test, depth test, stencil update and depth write on covered[b] of each block;
  /// leaves in its place the pixels that pass all and returns the blocks where there are some.
  BlockMask (*test_blocks)(const FragmentTests& tests, const TestedBlocks& tested,
                           PixelMask* covered) noexcept;

  /// The same where nothing but the depth test decides, depth is only read, and the one stencil
  /// operation that is not `keep` adds `delta` modulo 256: to pixels that pass the depth test, or
  /// to those that fail it. `covered` has some pixel in each block, and stays.
  void (*count_blocks)(CompareFunc func, bool on_pass, std::uint8_t delta,
                       const TestedBlocks& tested, const PixelMask* covered) noexcept;

  /// Adds deltas[b] modulo 256 to the 64 stencils of each block of a tile.
  void (*add_to_blocks)(const std::uint8_t* deltas, std::uint8_t* stencil) noexcept;

  /// The blocks of a tile that hold a stencil which passes the test.
  BlockMask (*stencil_blocks)(const FragmentTests& tests, const std::uint8_t* stencil) noexcept;

  /// The least and the greatest of a block's 64 depths.
  void (*depth_range)(const std::uint32_t* depth, std::uint32_t& least,
                      std::uint32_t& greatest) noexcept;

  /// Writes one colour (its four bytes as they lie in memory) to the pixels of the mask.
  void (*fill_block)(std::uint32_t color, PixelMask mask, std::uint8_t* stored) noexcept;

  /// Writes 64 RGBA8 source colours over the pixels of the mask: blending, then the colour mask
  /// (raster/blend.h). Four bytes a pixel: r, g, b, a; `constant` is the blend's constant colour.
  void (*blend_block)(const ColorState& state, const std::uint8_t (&constant)[4], PixelMask mask,
                      const std::uint8_t* source, std::uint8_t* stored) noexcept;

  /// Colours the pixels masks[b] (there are some) of each of the blocks and writes them.
  /// Null in plain C++: there shade(), interpolate() and BlockWriter do it, pixel by pixel.
  void (*shade_and_store)(const TileShading& shading, BlockMask blocks, const PixelMask* masks,
                          const ColorTile& colors) noexcept;

  /// The comparison holds at no fragment that lies between the positions with these indices, of
  /// triangles that are not cut; false also where that is not found out.
  /// Null in plain C++.
  bool (*lookup_fails)(const LookupBounds& bounds, const glm::vec4* positions,
                       const std::uint32_t* index, int count) noexcept;

  /// Rounds the mask's pixels (there are some) of 64 colours in four planes to RGBA8
  /// (raster/unorm.h) and stores them; the others stay.
  void (*store_colors)(const float* colors, PixelMask mask, std::uint8_t* stored) noexcept;

  /// Clip-space positions of `count` vertices: ((m0 x + m1 y) + m2 z) + m3 w in float32, each
  /// operation rounded once.
  void (*transform)(const glm::mat4& clip_from_model, const glm::vec4* positions, std::size_t count,
                    glm::vec4* out) noexcept;

  /// Projects and snaps `count` vertices; those that the clip volume does not hold get kClipped.
  void (*project)(const Projection& projection, const glm::vec4* clip, std::size_t count,
                  const ProjectedPlanes& out) noexcept;

  /// What light_vertex() gives `count` vertices for front faces, and for back faces that are lit
  /// with the reversed normal; either may be null. Shadow maps have no part in it.
  /// Null in plain C++: there light_vertex() does it, vertex by vertex.
  void (*light_vertices)(const Lighting& lighting, const LitAttributes& vertices, std::size_t count,
                         glm::vec4* front, glm::vec4* back) noexcept;

  /// Looks at `count` triangles, up to a batch of them.
  void (*select_triangles)(const TriangleSelector& selector, const std::uint32_t* indices,
                           std::size_t count, TriangleBatch& out) noexcept;
};

/// Misuse: an instruction set that available_isas() does not list.
const Kernels& kernels(Isa isa);
/// Those of a vector instruction set; null if this build or this machine has not got it.
const Kernels* simd_kernels(Isa isa);
const Kernels& scalar_kernels();

}  // namespace gnomon::raster
