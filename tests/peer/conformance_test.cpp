// The peer suite's cases as tests (oracle: Mesa's llvmpipe). peer_suite runs the same for any seed,
// prints the same tables and makes a failing case small; docs/peers.md holds the figures.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>

#include "describe.h"
#include "shrink.h"
#include "suite.h"

using namespace gnomon::peer;

namespace {

/// Runs so many seeds of a kind and prints their table. On llvmpipe the first failure is made small
/// and printed.
Tally run_seeds(Kind kind, std::uint32_t frames) {
  const OsmesaContext context(kCaseSize, kCaseSize);
  Tally tally;
  for (std::uint32_t seed = 0; seed < frames; ++seed) {
    const Case tried = make_case(kind, seed);
    if (!run_case(context, kind, tried, tally) || !context.is_llvmpipe()) continue;
    const Case smallest = shrink(tried, [&](const Case& smaller) {
      Tally unused;
      return run_case(context, kind, smaller, unused).has_value();
    });
    ADD_FAILURE() << name(kind) << " seed " << seed << ", its smallest case:\n"
                  << describe(smallest);
    break;
  }
  std::printf("%s\n%s", context.renderer().c_str(), table(kind, tally).c_str());
  return tally;
}

}  // namespace

TEST(Conformance, GridAlignedTrianglesInRandomStatesLeaveEveryByteAsOpenGLDoes) {
  const Tally tally = run_seeds(Kind::grid, 100);
  EXPECT_EQ(tally.draws, 20000u);
}

TEST(Conformance, EveryDifferenceOfFreeTrianglesIsAHistoryThatSnapAndRoundingAllow) {
  const Tally tally = run_seeds(Kind::free, 100);
  EXPECT_GT(tally.differing.depth, 0u) << "nothing to explain proves nothing";
}

TEST(Conformance, DepthLookupsAtExactCoordinatesGiveOpenGLsColours) {
  run_seeds(Kind::lookup, 100);
}
