// Facing and culling. Grid: dEQP culling.* (face x front face x winding) with two-sided stencil.
// Oracles: the slow reference for the bytes; a truth table for what is drawn and as which face.
#include <gtest/gtest.h>

#include "grid.h"
#include "raster/random_frames.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using gnomon::random_frames::Random;

namespace {

constexpr std::array<Cull, 4> kCulls{Cull::none, Cull::front, Cull::back, Cull::front_and_back};
constexpr std::array<FrontFace, 2> kFrontFaces{FrontFace::ccw, FrontFace::cw};

State culling(Cull cull, FrontFace front_face) {
  return {.depth = DepthState{CompareFunc::always, true},
          .stencil = StencilState{{.pass = StencilOp::incr_wrap}, {.pass = StencilOp::decr_wrap}},
          .cull = cull,
          .front_face = front_face};
}

std::string number(int n) { return std::to_string(n); }

}  // namespace

TEST(Culling, DrawsTheFacesThatItsTableSays) {
  Grid grid("culling faces x front faces x windings");
  for (const Size size : kSizes)
    for (const DepthFormat format : kDepthFormats)
      for (const Cull cull : kCulls)
        for (const FrontFace front_face : kFrontFaces)
          for (const bool clockwise : {false, true})
            for (const bool mirrored : {false, true}) {
              const State state = culling(cull, front_face);
              const std::string name = "cull " + number(static_cast<int>(cull)) + " front face " +
                                       number(static_cast<int>(front_face));
              const Expected expected = grid.check(
                  name, Buffers(size, format),
                  [&](Frame& frame, auto&) {
                    Draw draw{.state = state};
                    // A mirror in the matrix turns the winding over.
                    if (mirrored) draw.clip_from_model[0][0] = -1.0f;
                    record_draw(frame, draw, {clockwise ? reversed(full_quad()) : full_quad()});
                  },
                  Runs::every_variant);
              const bool front = (clockwise != mirrored) == (front_face == FrontFace::cw);
              const bool drawn = cull == Cull::none || (cull == Cull::front && !front) ||
                                 (cull == Cull::back && front);
              for (const std::uint8_t s : expected.only().stencil.to_rows())
                ASSERT_EQ(s, !drawn ? 0 : front ? 1 : 255) << name;
            }
}

TEST(Culling, OfRandomMeshesSplitsThemInTwo) {
  // Invariant: what culling front leaves and what culling back leaves add up to the whole.
  Grid grid("culling random meshes");
  for (std::uint32_t seed = 1; seed <= 60; ++seed)
    for (const Size size : kSizes)
      for (const FrontFace front_face : kFrontFaces) {
        Random random(seed);
        std::vector<glm::vec4> positions;
        for (int i = 0; i < 45; ++i) {
          const float w = random.real(-0.3f, 2.0f), x = random.real(-2.0f, 2.0f);
          positions.push_back({x, random.real(-2.0f, 2.0f), random.real(-1.5f, 1.5f), w});
        }
        std::array<std::uint64_t, 4> fragments{};
        for (const Cull cull : kCulls) {
          const Expected expected = grid.check(
              "seed " + number(static_cast<int>(seed)), Buffers(size), [&](Frame& frame, auto&) {
                record_draw(frame, {.state = culling(cull, front_face)}, {positions});
              });
          fragments[static_cast<std::size_t>(cull)] = expected.outcomes.pass;
        }
        EXPECT_EQ(fragments[0], fragments[1] + fragments[2]) << seed;
        EXPECT_EQ(fragments[3], 0u) << seed;
      }
}
