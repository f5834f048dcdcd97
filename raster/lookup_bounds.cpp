#include "raster/lookup_bounds.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gnomon::raster {

namespace {

/// The kernel's bounds of rounding hold for matrices whose numbers are not larger.
bool is_moderate(const glm::mat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!(std::abs(m[c][r]) <= 1e6f)) return false;
  return true;
}

bool is_small_and_positive(const glm::vec4& color) {
  // Bits of floats that are not negative are in their order, and those of others are greater.
  constexpr auto kMost = std::bit_cast<std::uint32_t>(1e18f);
  bool holds = true;
  for (int c = 0; c < 4; ++c) holds = holds && std::bit_cast<std::uint32_t>(color[c]) <= kMost;
  return holds;
}

bool zero_keeps(BlendOp op, BlendFactor source, BlendFactor stored, ColorFormat format) {
  if (stored != BlendFactor::one && op != BlendOp::max) return false;
  // A stored -0 would become 0 in a sum and as the greater one, and 0 times infinity is not 0.
  if (format == ColorFormat::rgba32f)
    return op == BlendOp::reverse_subtract && source == BlendFactor::one;
  return op == BlendOp::add || op == BlendOp::reverse_subtract || op == BlendOp::max;
}

}  // namespace

std::pmr::vector<LookupRange> lookup_ranges(const Draw& draw, const DepthLookup& lookup,
                                            const Kernels& kernels,
                                            std::pmr::memory_resource& memory) {
  constexpr std::size_t kBlocksPerTriangle = 4;
  const TiledPlane<std::uint32_t>& texels = lookup.map->plane();
  const int blocks_x = (texels.width() + kBlockSize - 1) / kBlockSize,
            blocks_y = (texels.height() + kBlockSize - 1) / kBlockSize;
  std::pmr::vector<LookupRange> ranges(&memory);
  const std::size_t count = static_cast<std::size_t>(blocks_x) * blocks_y;
  if (count > kBlocksPerTriangle * (draw.mesh.indices.size() / 3) ||
      !is_moderate(lookup.map_from_position))
    return ranges;
  ranges.reserve(count);
  // What pads a block that sticks out of the map only widens its range.
  for (int y = 0; y < blocks_y; ++y)
    for (int x = 0; x < blocks_x; ++x) {
      LookupRange& range = ranges.emplace_back();
      kernels.depth_range(&texels.at(x * kBlockSize, y * kBlockSize), range.least, range.greatest);
    }
  return ranges;
}

bool zero_keeps(const Draw& draw, const Flat& flat, ColorFormat format) {
  const ColorState& state = draw.state.color;
  if (!state.blend) return false;
  const Blend& b = *state.blend;
  const bool rgb_stays = flat.depth_texture_mode != DepthTextureMode::alpha &&
                         zero_keeps(b.color_op, b.src_color, b.dst_color, format);
  const bool alpha_stays = flat.depth_texture_mode != DepthTextureMode::luminance &&
                           zero_keeps(b.alpha_op, b.src_alpha, b.dst_alpha, format);
  const bool writes_rgb = state.write[0] || state.write[1] || state.write[2];
  if ((writes_rgb && !rgb_stays) || (state.write[3] && !alpha_stays)) return false;
  // A product of 0 and a float that is negative, infinite or no number is not +0.
  return format == ColorFormat::rgba8 ||
         (is_small_and_positive(flat.color) &&
          std::ranges::all_of(draw.mesh.colors, is_small_and_positive));
}

std::optional<std::array<glm::vec4, 8>> PositionBox::corners() const {
  if (least_.w != greatest_.w) return std::nullopt;
  std::array<glm::vec4, 8> out;
  for (std::size_t i = 0; i < 8; ++i)
    out[i] = {i & 1 ? greatest_.x : least_.x, i & 2 ? greatest_.y : least_.y,
              i & 4 ? greatest_.z : least_.z, least_.w};
  return out;
}

}  // namespace gnomon::raster
