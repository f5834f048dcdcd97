#include "reference/fragment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gnomon::reference {

namespace {

using namespace gnomon::raster;

bool holds(CompareFunc func, std::int64_t a, std::int64_t b) {
  switch (func) {
    case CompareFunc::never:
      return false;
    case CompareFunc::less:
      return a < b;
    case CompareFunc::equal:
      return a == b;
    case CompareFunc::less_equal:
      return a <= b;
    case CompareFunc::greater:
      return a > b;
    case CompareFunc::not_equal:
      return a != b;
    case CompareFunc::greater_equal:
      return a >= b;
    case CompareFunc::always:
      return true;
  }
  return false;
}

int after(StencilOp op, int value, int ref) {
  switch (op) {
    case StencilOp::keep:
      return value;
    case StencilOp::zero:
      return 0;
    case StencilOp::replace:
      return ref;
    case StencilOp::incr:
      return std::min(value + 1, 255);
    case StencilOp::incr_wrap:
      return (value + 1) % 256;
    case StencilOp::decr:
      return std::max(value - 1, 0);
    case StencilOp::decr_wrap:
      return (value + 255) % 256;
    case StencilOp::invert:
      return 255 - value;
  }
  return value;
}

int merge(int old, int value, int mask) { return (old & ~mask & 255) | (value & mask); }

int to_8_bits(float v) {
  if (std::isnan(v)) return 0;
  return static_cast<int>(std::nearbyint(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

std::array<int, 4> to_8_bits(const glm::vec4& v) {
  return {to_8_bits(v.x), to_8_bits(v.y), to_8_bits(v.z), to_8_bits(v.w)};
}

template <class T>
using Channels = std::array<T, 4>;

/// A blend factor in a colour type whose unit is `one`.
template <class T>
T factor(BlendFactor f, std::size_t c, const Channels<T>& s, const Channels<T>& d,
         const Channels<T>& k, T one) {
  const bool minus =
      f == BlendFactor::one_minus_src_color || f == BlendFactor::one_minus_dst_color ||
      f == BlendFactor::one_minus_src_alpha || f == BlendFactor::one_minus_dst_alpha ||
      f == BlendFactor::one_minus_constant_color || f == BlendFactor::one_minus_constant_alpha;
  T value = 0;
  switch (f) {
    case BlendFactor::zero:
      return 0;
    case BlendFactor::one:
      return one;
    case BlendFactor::src_color:
    case BlendFactor::one_minus_src_color:
      value = s[c];
      break;
    case BlendFactor::dst_color:
    case BlendFactor::one_minus_dst_color:
      value = d[c];
      break;
    case BlendFactor::src_alpha:
    case BlendFactor::one_minus_src_alpha:
      value = s[3];
      break;
    case BlendFactor::dst_alpha:
    case BlendFactor::one_minus_dst_alpha:
      value = d[3];
      break;
    case BlendFactor::constant_color:
    case BlendFactor::one_minus_constant_color:
      value = k[c];
      break;
    case BlendFactor::constant_alpha:
    case BlendFactor::one_minus_constant_alpha:
      value = k[3];
      break;
    case BlendFactor::src_alpha_saturate:
      return c == 3 ? one : std::min<T>(s[3], one - d[3]);
  }
  return minus ? one - value : value;
}

/// One channel's blend, in units of one * one.
template <class T>
T blended(const Blend& b, std::size_t c, const Channels<T>& s, const Channels<T>& d,
          const Channels<T>& k, T one) {
  const T fs = factor(c == 3 ? b.src_alpha : b.src_color, c, s, d, k, one);
  const T fd = factor(c == 3 ? b.dst_alpha : b.dst_color, c, s, d, k, one);
  switch (c == 3 ? b.alpha_op : b.color_op) {
    case BlendOp::add:
      return s[c] * fs + d[c] * fd;
    case BlendOp::subtract:
      return s[c] * fs - d[c] * fd;
    case BlendOp::reverse_subtract:
      return d[c] * fd - s[c] * fs;
    case BlendOp::min:
      return std::min(s[c], d[c]) * one;
    case BlendOp::max:
      return std::max(s[c], d[c]) * one;
  }
  return 0;
}

void write_rgba8(Rgba8& stored, const ColorState& state, const glm::vec4& color) {
  const Channels<int> s = to_8_bits(color), d{stored[0], stored[1], stored[2], stored[3]};
  for (std::size_t c = 0; c < 4; ++c) {
    if (!state.write[c]) continue;
    double value = s[c];
    if (state.blend)
      value = blended<int>(*state.blend, c, s, d, to_8_bits(state.blend->constant), 255) / 255.0;
    stored[c] = static_cast<std::uint8_t>(std::floor(std::clamp(value, 0.0, 255.0) + 0.5));
  }
}

void write_color(ColorBuffer& target, int x, int y, const ColorState& state,
                 const glm::vec4& color) {
  if (target.format() == ColorFormat::rgba8) {
    write_rgba8(target.rgba8().at(x, y), state, color);
    return;
  }
  glm::vec4& stored = target.rgba32f().at(x, y);
  const Channels<float> s{color.x, color.y, color.z, color.w};
  const Channels<float> d{stored.x, stored.y, stored.z, stored.w};
  for (std::size_t c = 0; c < 4; ++c) {
    if (!state.write[c]) continue;
    float value = s[c];
    if (state.blend) {
      const glm::vec4& k = state.blend->constant;
      value = blended<float>(*state.blend, c, s, d, {k.x, k.y, k.z, k.w}, 1.0f);
    }
    if (std::isnan(value) && std::isnan(d[c])) continue;
    stored[static_cast<int>(c)] =
        std::isnan(value) ? std::numeric_limits<float>::quiet_NaN() : value;
  }
}

/// Sets what lies in the world, of a normal and a position in the mesh's space.
void to_world(const Lit& lit, const glm::vec3& n, const glm::vec4& p, Fragment& out) {
  const glm::mat3& a = lit.world_from_model_normal;
  const glm::mat4& b = lit.world_from_model;
  for (int row = 0; row < 3; ++row) {
    out.normal[row] = (a[0][row] * n.x + a[1][row] * n.y) + a[2][row] * n.z;
    out.world[row] = (b[0][row] * p.x + b[1][row] * p.y) + (b[2][row] * p.z + b[3][row] * p.w);
  }
}

/// The colour of vertex i of a mesh that is lit at vertices, by whose fragments it is asked for.
glm::vec4 lit_vertex(const Draw& draw, const Lit& lit, std::uint32_t i, bool front_facing) {
  Fragment vertex;
  vertex.front_facing = front_facing;
  if (!draw.mesh.colors.empty()) vertex.color = draw.mesh.colors[i];
  to_world(lit, draw.mesh.normals[i], draw.mesh.positions[i], vertex);
  return light_vertex(lit, vertex);
}

}  // namespace

Outcome process_fragment(const Draw& draw, const Targets& targets, const Sample& sample,
                         const std::function<glm::vec4()>& color) {
  const State& state = draw.state;
  const int x = sample.x, y = sample.y;
  const bool stencil_test = state.stencil && targets.stencil;
  StencilFace face;
  if (stencil_test) face = sample.front_facing ? state.stencil->front : state.stencil->back;
  const int ref =
      std::clamp(sample.front_facing ? draw.stencil_ref.front : draw.stencil_ref.back, 0, 255);
  const auto update = [&](StencilOp op) {
    if (!stencil_test) return;
    std::uint8_t& s = targets.stencil->plane().at(x, y);
    s = static_cast<std::uint8_t>(merge(s, after(op, s, ref), face.write_mask));
  };
  if (stencil_test &&
      !holds(face.func, ref & face.read_mask, targets.stencil->at(x, y) & face.read_mask)) {
    update(face.fail);
    return Outcome::stencil_fail;
  }
  if (state.depth && targets.depth) {
    if (!holds(state.depth->func, sample.depth, targets.depth->at(x, y))) {
      update(face.depth_fail);
      return Outcome::depth_fail;
    }
    if (state.depth->write) targets.depth->plane().at(x, y) = sample.depth;
  }
  update(face.pass);
  const auto& write = state.color.write;
  if (targets.color && (write[0] || write[1] || write[2] || write[3]))
    write_color(*targets.color, x, y, state.color, color());
  return Outcome::pass;
}

Fragment interpolate(const Draw& draw, const std::uint32_t* index, const glm::vec3& w,
                     bool front_facing) {
  const auto mix = [&](auto values) {
    return (values[index[0]] * w.x + values[index[1]] * w.y) + values[index[2]] * w.z;
  };
  Fragment fragment;
  fragment.front_facing = front_facing;
  const Lit* const lit = std::get_if<Lit>(&draw.shading);
  if (!draw.mesh.colors.empty()) fragment.color = mix(draw.mesh.colors);
  if (lit && lit->at_vertices) {
    std::array<glm::vec4, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = lit_vertex(draw, *lit, index[k], front_facing);
    fragment.color = (c[0] * w.x + c[1] * w.y) + c[2] * w.z;
  }
  if (!draw.mesh.texcoords.empty()) fragment.texcoord = mix(draw.mesh.texcoords);
  fragment.model = mix(draw.mesh.positions);
  if (lit) to_world(*lit, mix(draw.mesh.normals), mix(draw.mesh.positions), fragment);
  return fragment;
}

void clear_pixel(const Clear& clear, const Targets& targets, int x, int y) {
  if (clear.color) write_color(*targets.color, x, y, {clear.color_write, {}}, *clear.color);
  if (clear.depth && clear.depth_write) {
    const double v = std::clamp(static_cast<double>(*clear.depth), 0.0, 1.0);
    targets.depth->plane().at(x, y) =
        static_cast<std::uint32_t>(std::nearbyint(v * targets.depth->max_value()));
  }
  if (clear.stencil) {
    std::uint8_t& s = targets.stencil->plane().at(x, y);
    s = static_cast<std::uint8_t>(merge(s, *clear.stencil, clear.stencil_write_mask));
  }
}

void blit_pixel(const Blit& blit, const Targets& targets, int x, int y,
                const std::uint8_t* channels) {
  glm::vec4 color(0.0f);
  for (int c = 0; c < blit.image.channels; ++c) color[c] = static_cast<float>(channels[c]) / 255.0f;
  write_color(*targets.color, x, y, {blit.color_write, {}}, color);
}

}  // namespace gnomon::reference
