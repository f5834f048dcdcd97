// A test that runs once on every instruction set that this machine has.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "raster/execute.h"

namespace gnomon {

class IsaTest : public ::testing::TestWithParam<raster::Isa> {
 protected:
  /// On one thread in even rounds, on three in odd ones.
  static raster::ExecuteOptions options(int round = 1) {
    return {.threads = round % 2 ? 3 : 1, .isa = GetParam()};
  }
};

}  // namespace gnomon

#define GNOMON_ON_EVERY_ISA(Suite)                                  \
  INSTANTIATE_TEST_SUITE_P(                                         \
      EveryIsa, Suite,                                              \
      ::testing::ValuesIn(gnomon::raster::available_isas().begin(), \
                          gnomon::raster::available_isas().end()),  \
      [](const auto& isa) { return std::string(gnomon::raster::name(isa.param)); })
