// The ways a frame can be executed that must all leave the same bytes: every instruction set that
// this machine has, on several numbers of threads.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "raster/execute.h"

namespace gnomon::variants {

inline constexpr std::array<int, 5> kThreads{1, 2, 3, 7, 16};

/// Every instruction set on so many threads.
inline std::vector<raster::ExecuteOptions> every_isa(int threads) {
  std::vector<raster::ExecuteOptions> all;
  for (const raster::Isa isa : raster::available_isas())
    all.push_back({.threads = threads, .isa = isa});
  return all;
}

/// Every instruction set on every number of threads.
inline std::vector<raster::ExecuteOptions> every_variant() {
  std::vector<raster::ExecuteOptions> all;
  for (const int threads : kThreads)
    for (const raster::ExecuteOptions& options : every_isa(threads)) all.push_back(options);
  return all;
}

/// "avx2 on 7 threads".
inline std::string name(const raster::ExecuteOptions& options) {
  return std::string(raster::name(options.isa)) + " on " + std::to_string(options.threads) +
         " threads";
}

}  // namespace gnomon::variants
