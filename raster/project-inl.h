// Vector kernel: clip codes and projection of vertices, the operations of raster/project.cpp in the
// same order. Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_PROJECT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_PROJECT_INL_H
#undef GNOMON_RASTER_PROJECT_INL_H
#else
#define GNOMON_RASTER_PROJECT_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A vector of float32 holds the vertices of two vectors of double.
using DVertex = hn::ScalableTag<float>;
using DVertexHalf = hn::Half<DVertex>;
using DWindow = hn::RepartitionToWide<DVertex>;
using VWindow = hn::Vec<DWindow>;

HWY_INLINE hn::Mask<DWindow> inside_volume(const ClipVolume& volume, VWindow x, VWindow y,
                                           VWindow z, VWindow w) {
  const DWindow d;
  const VWindow zero = hn::Zero(d), guard_x = hn::Mul(hn::Set(d, volume.guard_x), w),
                guard_y = hn::Mul(hn::Set(d, volume.guard_y), w);
  auto inside = hn::Ge(hn::Sub(w, hn::Set(d, kMinW)), zero);
  if (volume.near_and_far)
    inside = hn::And(inside, hn::And(hn::Ge(hn::Add(w, z), zero), hn::Ge(hn::Sub(w, z), zero)));
  inside = hn::And(inside,
                   hn::And(hn::Ge(hn::Add(guard_x, x), zero), hn::Ge(hn::Sub(guard_x, x), zero)));
  return hn::And(inside,
                 hn::And(hn::Ge(hn::Add(guard_y, y), zero), hn::Ge(hn::Sub(guard_y, y), zero)));
}

HWY_INLINE VWindow rounded(VWindow value, double lowest, double highest) {
  const DWindow d;
  return hn::Round(hn::Min(hn::Max(value, hn::Set(d, lowest)), hn::Set(d, highest)));
}

/// Whole numbers as 64-bit integers: below 2^51 by the bits of a sum with 2^52 + 2^51, whose unit
/// is 1.
HWY_INLINE auto to_integers(VWindow whole, bool below_2_51) {
  const DWindow d;
  const hn::RebindToSigned<DWindow> signed_d;
  if (!below_2_51) return hn::ConvertTo(signed_d, whole);
  const VWindow magic = hn::Set(d, 0x1.8p52);
  return hn::Sub(hn::BitCast(signed_d, hn::Add(whole, magic)), hn::BitCast(signed_d, magic));
}

HWY_INLINE void project_half(const Projection& p, VWindow x, VWindow y, VWindow z, VWindow w,
                             bool small_depths, const ProjectedPlanes& out, std::size_t i) {
  const DWindow d;
  const hn::Rebind<std::int32_t, DWindow> narrow_d;
  const hn::RebindToSigned<DWindow> wide_d;
  constexpr double kLimit = kMaxCoordinate;
  const auto window = [&](VWindow clip, double scale, double middle) HWY_ATTR {
    return hn::Add(hn::Mul(hn::Div(clip, w), hn::Set(d, scale)), hn::Set(d, middle));
  };
  const VWindow subpixels = hn::Set(d, 256.0);
  const VWindow snapped_x =
      rounded(hn::Mul(window(x, p.scale_x, p.middle_x), subpixels), -kLimit, kLimit);
  const VWindow snapped_y =
      rounded(hn::Mul(window(y, p.scale_y, p.middle_y), subpixels), -kLimit, kLimit);
  const VWindow depth = rounded(
      hn::Mul(window(z, p.scale_depth, p.middle_depth), hn::Set(d, p.one)), p.lowest, p.highest);
  const VWindow x_or_clipped = hn::IfThenElse(inside_volume(p.volume, x, y, z, w), snapped_x,
                                              hn::Set(d, static_cast<double>(kClipped)));
  hn::StoreU(hn::DemoteTo(narrow_d, x_or_clipped), narrow_d, out.x_fx + i);
  hn::StoreU(hn::DemoteTo(narrow_d, snapped_y), narrow_d, out.y_fx + i);
  hn::StoreU(to_integers(depth, small_depths), wide_d, out.z_fx + i);
  hn::StoreU(hn::Div(hn::Set(d, 1.0), w), d, out.inverse_w + i);
}

/// As many vertices as a vector of float32 has lanes.
HWY_INLINE void project_vector(const Projection& p, const float* clip, const ProjectedPlanes& out,
                               std::size_t i) {
  const DVertex d;
  const DVertexHalf half_d;
  const DWindow wide_d;
  hn::Vec<DVertex> x, y, z, w;
  hn::LoadInterleaved4(d, clip, x, y, z, w);
  // Infinity and NaN less themselves are NaN, which is not 0 and so in no volume.
  const auto nothing = hn::Add(hn::Add(hn::Sub(x, x), hn::Sub(y, y)), hn::Sub(z, z));
  w = hn::Add(w, hn::Add(nothing, hn::Sub(w, w)));
  const bool small_depths = p.highest < 0x1p51 && p.lowest > -0x1p51;
  const auto low = [&](hn::Vec<DVertex> v)
                       HWY_ATTR { return hn::PromoteTo(wide_d, hn::LowerHalf(half_d, v)); };
  const auto high = [&](hn::Vec<DVertex> v)
                        HWY_ATTR { return hn::PromoteTo(wide_d, hn::UpperHalf(half_d, v)); };
  project_half(p, low(x), low(y), low(z), low(w), small_depths, out, i);
  project_half(p, high(x), high(y), high(z), high(w), small_depths, out, i + hn::Lanes(wide_d));
}

void project(const Projection& projection, const glm::vec4* clip, std::size_t count,
             const ProjectedPlanes& out) noexcept {
  constexpr std::size_t kMost = hn::MaxLanes(DVertex());
  const std::size_t lanes = hn::Lanes(DVertex());
  const auto* const from = reinterpret_cast<const float*>(clip);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) project_vector(projection, from + 4 * i, out, i);
  if (i == count) return;
  // The rest, filled up with zeros.
  float rest[4 * kMost] = {};
  std::int32_t x_fx[kMost], y_fx[kMost];
  std::int64_t z_fx[kMost];
  double inverse_w[kMost];
  for (std::size_t k = 0; k < 4 * (count - i); ++k) rest[k] = from[4 * i + k];
  project_vector(projection, rest, {x_fx, y_fx, z_fx, inverse_w}, 0);
  for (std::size_t k = 0; i < count; ++i, ++k) {
    out.x_fx[i] = x_fx[k];
    out.y_fx[i] = y_fx[k];
    out.z_fx[i] = z_fx[k];
    out.inverse_w[i] = inverse_w[k];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
