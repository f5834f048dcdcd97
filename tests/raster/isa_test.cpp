#include "raster/isa.h"

#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "raster/buffers.h"
#include "raster/execute.h"

using namespace gnomon::raster;

namespace {

std::vector<Isa> available() { return {available_isas().begin(), available_isas().end()}; }

#ifdef __x86_64__

struct Promise {
  Isa isa;
  /// As /proc/cpuinfo spells what this one has and the one before has not.
  const char* flags;
};

constexpr Promise kPromises[] = {
    {Isa::ssse3, "pni ssse3"},
    {Isa::sse4, "sse4_1 sse4_2 pclmulqdq aes"},
    {Isa::avx2, "avx avx2 fma f16c bmi1 bmi2"},
    {Isa::avx512, "avx512f avx512bw avx512cd avx512dq avx512vl"},
    {Isa::avx512_dl,
     "avx512_vnni avx512vbmi avx512_vbmi2 avx512_bitalg avx512_vpopcntdq vpclmulqdq vaes gfni"}};

/// What the whole program was compiled for: narrower kernels are left out then.
#if defined(__AVX512VBMI2__)
constexpr Isa kBaseline = Isa::avx512_dl;
#elif defined(__AVX512BW__)
constexpr Isa kBaseline = Isa::avx512;
#elif defined(__AVX2__)
constexpr Isa kBaseline = Isa::avx2;
#elif defined(__SSE4_2__)
constexpr Isa kBaseline = Isa::sse4;
#else
constexpr Isa kBaseline = Isa::scalar;
#endif

std::set<std::string> processor_flags() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    std::istringstream words(line);
    std::string word;
    if (words >> word && word == "flags")
      return {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()};
  }
  return {};
}

/// Those whose flags, and the flags of all narrower ones, the processor has.
std::vector<Isa> promised() {
  const std::set<std::string> has = processor_flags();
  std::vector<Isa> isas{Isa::scalar};
  for (const Promise& promise : kPromises) {
    std::istringstream words(promise.flags);
    for (std::string flag; words >> flag;)
      if (!has.contains(flag)) return isas;
    if (promise.isa >= kBaseline) isas.push_back(promise.isa);
  }
  return isas;
}

#elif defined(__aarch64__)

/// The architecture has no processor without NEON.
std::vector<Isa> promised() { return {Isa::scalar, Isa::neon}; }

#endif

}  // namespace

#if defined(__x86_64__) || defined(__aarch64__)
TEST(Isa, EveryOneThatTheProcessorPromisesIsAvailable) {  // oracle: /proc/cpuinfo
  std::cout << "instruction sets:";
  for (const Isa isa : available()) std::cout << ' ' << name(isa);
  std::cout << '\n';
  EXPECT_THAT(available(), testing::IsSupersetOf(promised()));
}
#endif

TEST(Isa, ScalarComesFirstAndBestIsNotListed) {
  EXPECT_EQ(available().front(), Isa::scalar);
  EXPECT_THAT(available(), testing::Not(testing::Contains(Isa::best)));
}

TEST(Isa, NamesLeadBack) {
  for (const Isa isa : available()) EXPECT_EQ(isa_named(name(isa)), isa) << name(isa);
  EXPECT_EQ(isa_named("best"), Isa::best);
  EXPECT_EQ(isa_named("mmx"), std::nullopt);
}

TEST(Isa, OneThatTheMachineHasNotGotIsRefused) {
  StencilBuffer stencil(1, 1);
  Frame frame;
  frame.begin_pass("clear", {.stencil = &stencil});
  frame.clear({.stencil = 1});
  for (const Isa isa : {Isa::sse4, Isa::neon}) {
    if (testing::Matches(testing::Contains(isa))(available())) continue;
    EXPECT_THROW(execute(frame, {.isa = isa}), std::invalid_argument) << name(isa);
  }
}
