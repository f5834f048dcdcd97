// What Highway 1.0 lacks for WebAssembly of vectors of doubles, as far as the kernels for shading
// use it.
#if defined(GNOMON_RASTER_WASM_DOUBLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_WASM_DOUBLES_INL_H
#undef GNOMON_RASTER_WASM_DOUBLES_INL_H
#else
#define GNOMON_RASTER_WASM_DOUBLES_INL_H
#endif

#include <hwy/highway.h>

#if HWY_TARGET == HWY_WASM

#include <wasm_simd128.h>

HWY_BEFORE_NAMESPACE();
namespace hwy {
namespace HWY_NAMESPACE {

template <std::size_t kLanes>
HWY_API Vec128<double, kLanes> doubles(v128_t raw) {
  Vec128<double, kLanes> out;
  __builtin_memcpy(&out.raw, &raw, sizeof raw);
  return out;
}
template <std::size_t kLanes>
HWY_API v128_t raw_doubles(Vec128<double, kLanes> v) {
  v128_t out;
  __builtin_memcpy(&out, &v.raw, sizeof out);
  return out;
}

template <std::size_t kLanes>
HWY_API Vec128<double, kLanes> Set(Simd<double, kLanes, 0>, double value) {
  return doubles<kLanes>(wasm_f64x2_splat(value));
}
template <std::size_t kLanes>
HWY_API Vec128<double, kLanes> Iota(Simd<double, kLanes, 0>, double first) {
  return doubles<kLanes>(wasm_f64x2_make(first, first + 1.0));
}
template <std::size_t kLanes>
HWY_API Vec128<double, kLanes> Add(Vec128<double, kLanes> a, Vec128<double, kLanes> b) {
  return doubles<kLanes>(wasm_f64x2_add(raw_doubles(a), raw_doubles(b)));
}
template <std::size_t kLanes>
HWY_API Vec128<double, kLanes> Mul(Vec128<double, kLanes> a, Vec128<double, kLanes> b) {
  return doubles<kLanes>(wasm_f64x2_mul(raw_doubles(a), raw_doubles(b)));
}
template <std::size_t kLanes>
HWY_API Vec128<double, kLanes> Div(Vec128<double, kLanes> a, Vec128<double, kLanes> b) {
  return doubles<kLanes>(wasm_f64x2_div(raw_doubles(a), raw_doubles(b)));
}
/// Rounded to nearest, ties to even.
template <std::size_t kLanes>
HWY_API Vec128<float, kLanes> DemoteTo(Simd<float, kLanes, 0>, Vec128<double, kLanes> v) {
  const v128_t raw = wasm_f32x4_demote_f64x2_zero(raw_doubles(v));
  Vec128<float, kLanes> out;
  __builtin_memcpy(&out.raw, &raw, sizeof raw);
  return out;
}
}  // namespace HWY_NAMESPACE
}  // namespace hwy
HWY_AFTER_NAMESPACE();

#endif  // HWY_TARGET == HWY_WASM
#endif
