// Clipping of triangles with attributes. Grids: dEQP clipping.* (each plane with one, two and three
// vertices outside, each corner of the view volume), all signs of w, the guard band. Oracles: the
// slow reference for the bytes; closed forms for what is left.
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "grid.h"
#include "raster/random_frames.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using gnomon::random_frames::Random;

namespace {

std::string number(int n) { return std::to_string(n); }

std::shared_ptr<const Texture> ramp() {
  auto texture = std::make_shared<Texture>();
  texture->width = texture->height = 4;
  for (int i = 0; i < 16; ++i)
    texture->texels.push_back({static_cast<std::uint8_t>(17 * i), static_cast<std::uint8_t>(i * i),
                               static_cast<std::uint8_t>(255 - 16 * i), 255});
  return texture;
}

/// One textured and coloured triangle, both facings counted.
void record(Frame& frame, const std::array<glm::vec4, 3>& corners, bool depth_clamp,
            const std::optional<Rect>& viewport = {}) {
  static const std::shared_ptr<const Texture> kRamp = ramp();
  State state{
      .depth = DepthState{CompareFunc::always, true},
      .stencil = StencilState{{.pass = StencilOp::incr_wrap}, {.pass = StencilOp::decr_wrap}}};
  state.depth_clamp = depth_clamp;
  state.viewport = viewport;
  record_draw(frame, {.state = state, .shading = Flat{{1, 1, 1, 1}, kRamp}},
              {.positions = {corners.begin(), corners.end()},
               .colors = {{1, 0.5f, 0.1f, 1}, {0.2f, 1, 0.3f, 0.5f}, {0.6f, 0.4f, 1, 0.25f}},
               .texcoords = {{0, 0}, {1, 0.25f}, {-0.5f, 2}}});
}

/// D24 with RGBA32F and D16 with RGBA8 in turn.
Buffers targets(Size size, int i) {
  return i % 2 ? Buffers(size, DepthFormat::d24, ColorFormat::rgba32f)
               : Buffers(size, DepthFormat::d16, ColorFormat::rgba8);
}

std::uint64_t fragments(const Expected& expected) { return expected.outcomes.pass; }

}  // namespace

TEST(Clipping, EachPlaneCutsOneTwoOrThreeVertices) {
  Grid grid("clipping planes");
  const std::array<glm::vec4, 3> inner{
      glm::vec4{-0.8f, -0.7f, -0.3f, 1}, {0.9f, -0.5f, 0.4f, 1}, {-0.1f, 0.85f, 0.6f, 1}};
  int i = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f})
      for (int outside = 1; outside < 8; ++outside)
        for (const float reach : {1.0f, 1.0000001f, 1.5f, 40.0f, 1e6f, 1e12f})
          for (const float w : {1.0f, 3.0f, 0.01f})
            for (const Size size : {Size{7, 5}, Size{63, 65}}) {
              std::array<glm::vec4, 3> corners = inner;
              for (std::size_t v = 0; v < 3; ++v) {
                if (outside >> v & 1) corners[v][axis] = sign * reach;
                corners[v] = corners[v] * w;
              }
              const bool clamp = ++i % 3 == 0;
              const std::string name = "axis " + number(axis) + " outside " + number(outside);
              const Expected expected =
                  grid.check(name, targets(size, i), [&](Frame& frame, auto&) {
                    record(frame, corners, clamp, Rect{1, 1, size.width - 2, size.height - 2});
                  });
              for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                  if (x == 0 || y == 0 || x == size.width - 1 || y == size.height - 1) {
                    ASSERT_EQ(expected.only().stencil.at(x, y), 0) << name;
                  }
              if (outside == 7 && reach > 1.0f && !(clamp && axis == 2)) {
                EXPECT_EQ(fragments(expected), 0u) << name;
              }
              if (outside != 7 && size.width == 63 && reach < 40.0f) {
                EXPECT_GT(fragments(expected), 0u) << name;
              }
            }
}

TEST(Clipping, EachCornerOfTheViewVolumeIsCut) {
  Grid grid("clipping corners");
  int i = 0;
  for (int corner = 0; corner < 8; ++corner)
    for (const float reach : {1.25f, 2.0f, 100.0f})
      for (const float w : {1.0f, 0.125f, 7.0f})
        for (const Size size : kSizes)
          for (const bool clamp : {false, true}) {
            // A triangle across the corner: each vertex leaves along one axis.
            const glm::vec3 at{corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1};
            std::array<glm::vec4, 3> corners;
            for (int v = 0; v < 3; ++v) {
              glm::vec3 p = at * 0.4f;
              p[v] = at[v] * reach;
              corners[static_cast<std::size_t>(v)] = glm::vec4(p, 1.0f) * w;
            }
            grid.check("corner " + number(corner), targets(size, ++i),
                       [&](Frame& frame, auto&) { record(frame, corners, clamp); });
          }
}

TEST(Clipping, EverySignOfWLeavesThePartBeforeTheEye) {
  Grid grid("clipping signs of w");
  constexpr std::array<float, 5> kW{-1.0f, -1e-6f, 0.0f, 1e-8f, 1.0f};
  Random random(8);
  int i = 0;
  for (const float w0 : kW)
    for (const float w1 : kW)
      for (const float w2 : kW)
        for (int round = 0; round < 3; ++round)
          for (const Size size : kSizes)
            for (const bool clamp : {false, true}) {
              std::array<glm::vec4, 3> corners;
              for (glm::vec4& p : corners)
                for (int c = 0; c < 3; ++c) p[c] = random.real(-1.5f, 1.5f);
              corners[0].w = w0;
              corners[1].w = w1;
              corners[2].w = w2;
              const Expected expected = grid.check(
                  "w " + std::to_string(w0) + " " + std::to_string(w1) + " " + std::to_string(w2),
                  targets(size, ++i), [&](Frame& frame, auto&) { record(frame, corners, clamp); });
              // All behind the eye, or at infinity: nothing is in front of it.
              if (w0 <= 0 && w1 <= 0 && w2 <= 0) {
                EXPECT_EQ(fragments(expected), 0u);
              }
            }
}

TEST(Clipping, NearAndFarLeaveTheColumnsBetweenThem) {
  Grid grid("clipping near and far columns");
  // z = 2 x: inside for |x| <= 1/2, the middle half of the columns.
  for (const int width : {4, 64, 128})
    for (const float scale : {1.0f, 0.001f, 1000.0f}) {
      const Size size{width, 9};
      const Expected expected =
          grid.check("width " + number(width), targets(size, width / 64), [&](Frame& frame, auto&) {
            std::vector<glm::vec4> corners = full_quad();
            for (glm::vec4& p : corners) {
              p.z = 2 * p.x;
              p = p * scale;
            }
            record(frame, {corners[0], corners[1], corners[2]}, false);
            record(frame, {corners[3], corners[4], corners[5]}, false);
          });
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
          ASSERT_EQ(expected.only().stencil.at(x, y), x >= width / 4 && x < 3 * width / 4)
              << x << ' ' << y;
    }
}

TEST(Clipping, AHugeTriangleCoversEachPixelOnce) {
  Grid grid("clipping guard band");
  Random random(9);
  int i = 0;
  for (int power = 0; power <= 16; ++power)
    for (int round = 0; round < 6; ++round)
      for (const Size size : kSizes) {
        float reach = 4.0f;
        for (int k = 0; k < power; ++k) reach *= 10.0f;
        const float z = random.real(-0.9f, 0.9f), turn = random.real(-0.2f, 0.2f);
        const std::array<glm::vec4, 3> corners{glm::vec4{-reach, -reach + turn, z, 1},
                                               {reach, -reach * (1 + turn), z, 1},
                                               {turn * reach, reach, z, 1}};
        const Expected expected =
            grid.check("reach 4e" + number(power), targets(size, ++i),
                       [&](Frame& frame, auto&) { record(frame, corners, round % 2 == 0); });
        for (const std::uint8_t s : expected.only().stencil.to_rows()) ASSERT_EQ(s, 1) << power;
      }
}

TEST(Clipping, ACoordinateThatIsNotFiniteDrawsNothing) {
  Grid grid("clipping not finite");
  int i = 0;
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()})
    for (std::size_t v = 0; v < 3; ++v)
      for (int c = 0; c < 4; ++c)
        for (const Size size : kSizes)
          for (const bool clamp : {false, true}) {
            std::array<glm::vec4, 3> corners{glm::vec4{-1, -1, 0, 1}, {3, -1, 0, 1}, {-1, 3, 0, 1}};
            corners[v][c] = bad;
            const Expected expected =
                grid.check("vertex " + number(static_cast<int>(v)), targets(size, ++i),
                           [&](Frame& frame, auto&) { record(frame, corners, clamp); });
            EXPECT_EQ(fragments(expected), 0u);
          }
}
