// Which instruction set the pixel kernels use. It decides speed only: the bytes are the same for
// every one (docs/determinism.md).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace gnomon::raster {

enum class Isa : std::uint8_t {
  /// The widest one that the machine has.
  best,
  /// Plain C++, one pixel after the other.
  scalar,
  ssse3,
  sse4,
  avx2,
  /// AVX-512 F, BW, CD, DQ and VL (Skylake).
  avx512,
  /// AVX-512 with what Ice Lake added (VBMI, VNNI, BITALG and others).
  avx512_dl,
  neon,
  /// WebAssembly's vectors of 128 bits.
  wasm
};

/// Those that this build has and this machine can run: scalar first, then from narrow to wide;
/// never `best`.
std::span<const Isa> available_isas();

/// "best", "scalar", "ssse3", "sse4", "avx2", "avx512", "avx512_dl", "neon" or "wasm".
std::string_view name(Isa isa);
/// The one with this name; nothing if there is none.
std::optional<Isa> isa_named(std::string_view name);

}  // namespace gnomon::raster
