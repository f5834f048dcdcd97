// The kernels for every vector instruction set: written once with Highway in the -inl.h files,
// compiled once for each (foreach_target.h includes this file again and again).
// This file includes no header whose inline functions could be compiled here for a wide instruction
// set and then be kept by the linker for everyone.
#include "raster/kernels.h"

// Ice Lake's AVX-512 is not compiled unless it is asked for.
#define HWY_WANT_AVX3_DL
// An SVE vector has no size the compiler knows, and the kernels keep four of them in a struct.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE_256 | HWY_SVE2 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/kernels_simd.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

// A machine without vectors has the kernels in plain C++.
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128

// First: the others may need it.
#include "raster/wasm_doubles-inl.h"

#include "raster/blend_block-inl.h"
#include "raster/count_blocks-inl.h"
#include "raster/cover-inl.h"
#include "raster/depth_ranges-inl.h"
#include "raster/light_vertices-inl.h"
#include "raster/lookup_bounds-inl.h"
#include "raster/shade_blocks-inl.h"
#include "raster/test_blocks-inl.h"
#include "raster/transform-inl.h"
#if HWY_TARGET != HWY_WASM
#include "raster/project-inl.h"
#include "raster/select_triangles-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_WASM
// The front end is all doubles: here it is the one in plain C++, select_triangles too.
constexpr auto* project = &project_vertices;
#endif

const Kernels* kernels_of_this_target() {
  static constexpr Kernels kKernels{
      cover_blocks,   cover_pixels, compare_ranges, test_blocks,    count_blocks,    add_to_blocks,
      stencil_blocks, depth_range,  fill_block,     blend_block,    shade_and_store, lookup_fails,
      store_colors,   transform,    project,        light_vertices, select_triangles};
  return &kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif

#if HWY_ONCE
namespace gnomon::raster {

const Kernels* simd_kernels(Isa isa) {
#if HWY_ARCH_WASM
  // What a module was compiled with, it runs with.
  constexpr std::int64_t machine = HWY_TARGETS;
#else
  static const std::int64_t machine = hwy::SupportedTargets();
#endif
  [[maybe_unused]] const auto if_machine_has = [](std::int64_t target, const Kernels* kernels) {
    return (machine & target) != 0 ? kernels : nullptr;
  };
  switch (isa) {
#if HWY_TARGETS & HWY_SSSE3
    case Isa::ssse3:
      return if_machine_has(HWY_SSSE3, N_SSSE3::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return if_machine_has(HWY_SSE4, N_SSE4::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return if_machine_has(HWY_AVX2, N_AVX2::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return if_machine_has(HWY_AVX3, N_AVX3::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_AVX3_DL
    case Isa::avx512_dl:
      return if_machine_has(HWY_AVX3_DL, N_AVX3_DL::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::neon:
      return if_machine_has(HWY_NEON, N_NEON::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_WASM
    case Isa::wasm:
      return if_machine_has(HWY_WASM, N_WASM::kernels_of_this_target());
#endif
    default:
      return nullptr;
  }
}

}  // namespace gnomon::raster
#endif  // HWY_ONCE
