// What the two directions of the frame format agree on beside the fields (docs/frame-format.md).
#pragma once

#include <cstdint>
#include <string_view>

namespace gnomon::raster {

inline constexpr std::string_view kFrameMagic = "gnomon frame";
/// The newest version. Version 2 has Lit::at_vertices, which is false in version 1; version 3 has
/// Draw::parts, of which older ones have none.
inline constexpr std::uint32_t kFrameVersion = 3;
/// In an index's place: nothing is meant.
inline constexpr std::uint32_t kNone = 0xffffffff;

enum class BufferKind : std::uint8_t { color, depth, stencil };
/// Indices are written in two bytes each where all of them fit.
enum class ArrayType : std::uint8_t { vec2, vec3, vec4, index16, index32 };

}  // namespace gnomon::raster
