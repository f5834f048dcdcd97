// Vector kernel: vertices to clip space. Products and sums are apart (Mul, Add): nothing is fused.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_TRANSFORM_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_TRANSFORM_INL_H
#undef GNOMON_RASTER_TRANSFORM_INL_H
#else
#define GNOMON_RASTER_TRANSFORM_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A vector holds one or more vertices, four floats each; Broadcast works inside each four.
void transform(const glm::mat4& m, const glm::vec4* positions, std::size_t count,
               glm::vec4* out) noexcept {
  const hn::ScalableTag<float> d;
  const hn::FixedTag<float, 4> one_d;
  const auto run = [](auto tag, const float* columns, const float* from, float* to) HWY_ATTR {
    const auto p = hn::LoadU(tag, from);
    const auto x = hn::Mul(hn::LoadDup128(tag, columns), hn::Broadcast<0>(p));
    const auto y = hn::Mul(hn::LoadDup128(tag, columns + 4), hn::Broadcast<1>(p));
    const auto z = hn::Mul(hn::LoadDup128(tag, columns + 8), hn::Broadcast<2>(p));
    const auto w = hn::Mul(hn::LoadDup128(tag, columns + 12), hn::Broadcast<3>(p));
    hn::StoreU(hn::Add(hn::Add(hn::Add(x, y), z), w), tag, to);
  };
  const float* const columns = &m[0].x;
  const auto* const from = reinterpret_cast<const float*>(positions);
  auto* const to = reinterpret_cast<float*>(out);
  const std::size_t a_vector = hn::Lanes(d) / 4;
  std::size_t i = 0;
  for (; i + a_vector <= count; i += a_vector) run(d, columns, from + 4 * i, to + 4 * i);
  for (; i < count; ++i) run(one_d, columns, from + 4 * i, to + 4 * i);
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
