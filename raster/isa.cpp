#include "raster/isa.h"

#include <array>
#include <vector>

#include "raster/kernels.h"

namespace gnomon::raster {

namespace {

constexpr std::array<std::string_view, 9> kNames{"best",   "scalar",    "ssse3", "sse4", "avx2",
                                                 "avx512", "avx512_dl", "neon",  "wasm"};

}  // namespace

std::span<const Isa> available_isas() {
  static const std::vector<Isa> kAvailable = [] {
    std::vector<Isa> isas{Isa::scalar};
    for (const Isa isa :
         {Isa::wasm, Isa::neon, Isa::ssse3, Isa::sse4, Isa::avx2, Isa::avx512, Isa::avx512_dl})
      if (simd_kernels(isa)) isas.push_back(isa);
    return isas;
  }();
  return kAvailable;
}

std::string_view name(Isa isa) { return kNames.at(static_cast<std::size_t>(isa)); }

std::optional<Isa> isa_named(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return static_cast<Isa>(i);
  return std::nullopt;
}

}  // namespace gnomon::raster
