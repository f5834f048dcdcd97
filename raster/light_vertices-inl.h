// Vector kernel: lighting at vertices, the equation of raster/shade_colors-inl.h on attributes as
// they lie in the mesh. Read once for each instruction set, so its guard goes to and fro with
// Highway's.
#if defined(GNOMON_RASTER_LIGHT_VERTICES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_LIGHT_VERTICES_INL_H
#undef GNOMON_RASTER_LIGHT_VERTICES_INL_H
#else
#define GNOMON_RASTER_LIGHT_VERTICES_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"
#include "raster/shade_colors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

/// Clamped to [0, 1]; NaN is not greater than 0.
HWY_INLINE VF32 clamped(VF32 value) {
  const DF32 d;
  return hn::Min(hn::IfThenElseZero(hn::Gt(value, hn::Zero(d)), value), set(1.0f));
}

/// As many vertices as a vector has lanes, from the places of their attributes; `colors` is null if
/// they have none.
HWY_INLINE void light_vector(const Lighting& lighting, const float* positions, const float* normals,
                             const float* colors, float* front, float* back) {
  const DF32 d;
  const LitTerms& lit = *lighting.terms;
  const VF32 zero = hn::Zero(d), one = set(1.0f);
  Vector3 normal{zero, zero, zero}, world{zero, zero, zero}, base{one, one, one};
  VF32 alpha = one;
  hn::LoadInterleaved3(d, normals, normal.x, normal.y, normal.z);
  normal = world_normal(lit, normal);
  if (lit.world_matters) {
    VF32 x, y, z, w;
    hn::LoadInterleaved4(d, positions, x, y, z, w);
    world = world_position(lit, x, y, z, w);
  }
  if (colors) hn::LoadInterleaved4(d, colors, base.x, base.y, base.z, alpha);
  alpha = clamped(hn::Mul(set(lit.material_alpha), alpha));
  const auto light_side = [&](const Vector3& side, float* out) HWY_ATTR {
    if (!out) return;
    const Vector3 color = lit_color(lighting, side, world, colors != nullptr, base);
    hn::StoreInterleaved4(clamped(color.x), clamped(color.y), clamped(color.z), alpha, d, out);
  };
  light_side(normal, front);
  light_side(reversed(normal), back);
}

void light_vertices(const Lighting& lighting, const LitAttributes& vertices, std::size_t count,
                    glm::vec4* front, glm::vec4* back) noexcept {
  constexpr std::size_t kMost = hn::MaxLanes(DF32());
  const std::size_t lanes = hn::Lanes(DF32());
  const auto* const positions = reinterpret_cast<const float*>(vertices.positions);
  const auto* const normals = reinterpret_cast<const float*>(vertices.normals);
  const auto* const colors = reinterpret_cast<const float*>(vertices.colors);
  auto* const to_front = reinterpret_cast<float*>(front);
  auto* const to_back = reinterpret_cast<float*>(back);
  const auto from = [](auto* plane, std::size_t i) { return plane ? plane + 4 * i : nullptr; };
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes)
    light_vector(lighting, positions + 4 * i, normals + 3 * i, from(colors, i), from(to_front, i),
                 from(to_back, i));
  if (i == count) return;
  // The rest, filled up with zeros.
  float rest_positions[4 * kMost] = {}, rest_normals[3 * kMost] = {}, rest_colors[4 * kMost] = {};
  float rest_front[4 * kMost], rest_back[4 * kMost];
  const std::size_t rest = count - i;
  for (std::size_t k = 0; k < 3 * rest; ++k) rest_normals[k] = normals[3 * i + k];
  for (std::size_t k = 0; k < 4 * rest; ++k) {
    rest_positions[k] = positions[4 * i + k];
    if (colors) rest_colors[k] = colors[4 * i + k];
  }
  light_vector(lighting, rest_positions, rest_normals, colors ? rest_colors : nullptr,
               front ? rest_front : nullptr, back ? rest_back : nullptr);
  for (std::size_t k = 0; k < 4 * rest; ++k) {
    if (front) to_front[4 * i + k] = rest_front[k];
    if (back) to_back[4 * i + k] = rest_back[k];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
