// Everything that a draw can have of fixed-function state, as plain data with OpenGL's defaults.
// Names are OpenGL's (4.6 compatibility specification, chapters 13, 14 and 17). Absent means off;
// there is no current state.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <glm/vec4.hpp>

namespace gnomon::raster {

enum class CompareFunc : std::uint8_t {
  never,
  less,
  equal,
  less_equal,
  greater,
  not_equal,
  greater_equal,
  always
};

enum class StencilOp : std::uint8_t {
  keep,
  zero,
  replace,
  incr,
  incr_wrap,
  decr,
  decr_wrap,
  invert
};

/// Window coordinates in pixels, (x, y) the bottom left corner. May reach outside the target.
struct Rect {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Rect&) const = default;
};

/// Depth test and write. With the test off (absent) nothing is written either.
struct DepthState {
  CompareFunc func = CompareFunc::less;
  bool write = true;
  bool operator==(const DepthState&) const = default;
};

/// Stencil function, masks and operations of one facing. The reference belongs to the draw.
struct StencilFace {
  CompareFunc func = CompareFunc::always;
  std::uint8_t read_mask = 0xff, write_mask = 0xff;
  StencilOp fail = StencilOp::keep, depth_fail = StencilOp::keep, pass = StencilOp::keep;
  bool operator==(const StencilFace&) const = default;
};

/// References of the two facings; one number is for both. Clamped to [0, 255] where they are used.
struct StencilRef {
  int front = 0, back = 0;
  constexpr StencilRef(int both = 0) : front(both), back(both) {}
  constexpr StencilRef(int front_ref, int back_ref) : front(front_ref), back(back_ref) {}
  bool operator==(const StencilRef&) const = default;
};

struct StencilState {
  StencilFace front, back;
  /// The same state for both facings.
  static StencilState both(const StencilFace& face) { return {face, face}; }
  bool operator==(const StencilState&) const = default;
};

enum class BlendOp : std::uint8_t { add, subtract, reverse_subtract, min, max };

enum class BlendFactor : std::uint8_t {
  zero,
  one,
  src_color,
  one_minus_src_color,
  dst_color,
  one_minus_dst_color,
  src_alpha,
  one_minus_src_alpha,
  dst_alpha,
  one_minus_dst_alpha,
  constant_color,
  one_minus_constant_color,
  constant_alpha,
  one_minus_constant_alpha,
  src_alpha_saturate
};

struct Blend {
  BlendOp color_op = BlendOp::add, alpha_op = BlendOp::add;
  BlendFactor src_color = BlendFactor::one, dst_color = BlendFactor::zero;
  BlendFactor src_alpha = BlendFactor::one, dst_alpha = BlendFactor::zero;
  glm::vec4 constant{0.0f};
  bool operator==(const Blend&) const = default;
};

/// Colour mask (r, g, b, a) and blending.
struct ColorState {
  std::array<bool, 4> write{true, true, true, true};
  std::optional<Blend> blend;
  /// No channel is written.
  static ColorState off() { return {.write = {false, false, false, false}, .blend = {}}; }
  bool operator==(const ColorState&) const = default;
};

enum class Cull : std::uint8_t { none, front, back, front_and_back };
enum class FrontFace : std::uint8_t { ccw, cw };

/// factor * max(|dz/dx|, |dz/dy|) + units * r, where r is one unit of the depth buffer's format.
struct PolygonOffset {
  float factor = 0.0f, units = 0.0f;
  bool operator==(const PolygonOffset&) const = default;
};

struct DepthRange {
  float near = 0.0f, far = 1.0f;
  bool operator==(const DepthRange&) const = default;
};

struct State {
  std::optional<DepthState> depth;
  std::optional<StencilState> stencil;
  ColorState color;
  Cull cull = Cull::none;
  FrontFace front_face = FrontFace::ccw;
  std::optional<PolygonOffset> polygon_offset;
  std::optional<Rect> scissor;
  /// Absent: the whole target.
  std::optional<Rect> viewport;
  DepthRange depth_range;
  /// Near and far planes do not clip; depth is clamped per fragment to the depth range, after the
  /// offset.
  bool depth_clamp = false;
  bool operator==(const State&) const = default;
};

}  // namespace gnomon::raster
