// The front end's vector kernels against the plain ones, bit for bit: clip codes, projection and
// the choice of triangles, on vertices and triangles that meet every branch. The plain ones are
// held to the reference renderer with the rest of the rasterizer (tests/conformance).
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "isa_test.h"
#include "raster/depth_plane.h"
#include "raster/geometry.h"
#include "raster/isa.h"
#include "raster/kernels.h"
#include "raster/tile_blocks.h"

using namespace gnomon::raster;

namespace {

class FrontEnd : public ::testing::TestWithParam<Isa> {};
GNOMON_ON_EVERY_ISA(FrontEnd);

struct Projected {
  std::vector<std::int32_t> x_fx, y_fx;
  std::vector<std::int64_t> z_fx;
  std::vector<double> inverse_w;

  explicit Projected(std::size_t count)
      : x_fx(count, -1), y_fx(count, -1), z_fx(count, -1), inverse_w(count, -1.0) {}
  ProjectedPlanes planes() { return {x_fx.data(), y_fx.data(), z_fx.data(), inverse_w.data()}; }
};

/// Positions of every size, some of them on a plane of the clip volume to the bit, some not finite.
std::vector<glm::vec4> hostile_positions(std::size_t count, const ClipVolume& volume,
                                         std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f), exponent(-40.0f, 40.0f);
  std::uniform_int_distribution<int> one_of(0, 9), axis(0, 3);
  std::vector<glm::vec4> positions;
  while (positions.size() < count) {
    const float w = std::abs(unit(random)) * std::exp2(exponent(random) * 0.5f);
    glm::vec4 p(unit(random) * w * 1.2f, unit(random) * w * 1.2f, unit(random) * w * 1.1f, w);
    switch (one_of(random)) {
      case 0:
        p[axis(random)] = std::numeric_limits<float>::quiet_NaN();
        break;
      case 1:
        p[axis(random)] *= std::numeric_limits<float>::infinity();
        break;
      case 2:
        p.z = unit(random) > 0.0f ? p.w : -p.w;
        break;
      case 3:
        p.x = static_cast<float>(volume.guard_x) * (unit(random) > 0.0f ? p.w : -p.w);
        break;
      case 4:
        p = {unit(random), unit(random), 0.0f, static_cast<float>(kMinW) * (1.0f + unit(random))};
        break;
      case 5:
        p = glm::vec4(unit(random), unit(random), unit(random), unit(random)) *
            std::exp2(exponent(random));
        break;
      case 6:
        p.y = 0.0f * unit(random);
        break;
      default:
        break;
    }
    positions.push_back(p);
  }
  return positions;
}

Projection projection_of(DepthFormat format, bool depth_clamp, int size) {
  Draw draw;
  draw.state.depth_clamp = depth_clamp;
  draw.state.depth_range = {0.25f, 0.9f};
  DepthBuffer depth(size, size / 2, format);
  return make_draw_setup(draw, {.depth = &depth}).projection;
}

TEST_P(FrontEnd, ProjectsAsPlainCode) {
  std::mt19937 random(1);
  for (const DepthFormat format : {DepthFormat::d16, DepthFormat::d24}) {
    for (const bool depth_clamp : {false, true}) {
      const Projection projection = projection_of(format, depth_clamp, 1000);
      std::size_t kept = 0, clipped = 0;
      for (const std::size_t count : {1u, 2u, 3u, 7u, 16u, 33u, 5000u}) {
        const auto positions = hostile_positions(count, projection.volume, random);
        Projected expected(count), actual(count);
        scalar_kernels().project(projection, positions.data(), count, expected.planes());
        kernels(GetParam()).project(projection, positions.data(), count, actual.planes());
        for (std::size_t i = 0; i < count; ++i) {
          ASSERT_EQ(actual.x_fx[i], expected.x_fx[i]) << "vertex " << i << " of " << count;
          if (expected.x_fx[i] == kClipped) {
            ++clipped;
            continue;
          }
          ++kept;
          ASSERT_EQ(actual.y_fx[i], expected.y_fx[i]) << "vertex " << i << " of " << count;
          ASSERT_EQ(actual.z_fx[i], expected.z_fx[i]) << "vertex " << i << " of " << count;
          ASSERT_EQ(std::bit_cast<std::uint64_t>(actual.inverse_w[i]),
                    std::bit_cast<std::uint64_t>(expected.inverse_w[i]))
              << "vertex " << i << " of " << count;
        }
      }
      EXPECT_GT(kept, 1000u);
      EXPECT_GT(clipped, 1000u);
    }
  }
}

/// Triangles of 1/256 pixel to the largest coordinates, at and about a small target, some with
/// vertices that were clipped.
struct Soup {
  std::vector<std::int32_t> x_fx, y_fx;
  std::vector<std::int64_t> z_fx;
  std::vector<std::uint32_t> indices;

  TriangleSelector selector(bool ccw, bool cw, const PixelBox& box) const {
    return {x_fx.data(), y_fx.data(), z_fx.data(), ccw, cw, box};
  }
  SnappedVertex vertex(std::uint32_t i) const { return {x_fx[i], y_fx[i], z_fx[i]}; }
};

Soup triangle_soup(std::size_t triangles, std::mt19937& random) {
  Soup soup;
  std::uniform_int_distribution<std::int32_t> place(-20 * 256, 120 * 256),
      far(-kMaxCoordinate, kMaxCoordinate);
  std::uniform_int_distribution<int> one_of(0, 19), size(0, 4);
  // Depths are near each other or anywhere, up to D24's 1 in plane units.
  std::uniform_int_distribution<std::int64_t> depth(0, std::int64_t{0xffffff} << 8),
      near(0, std::int64_t{1} << 12);
  constexpr int kSizes[] = {40, 256, 700, 40 * 256, 400 * 256};
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::int32_t x = place(random), y = place(random);
    std::uniform_int_distribution<std::int32_t> offset(-kSizes[size(random)], kSizes[4] / 1000);
    const int kind = one_of(random);
    const std::int64_t z = depth(random) >> 1;
    for (int k = 0; k < 3; ++k) {
      soup.indices.push_back(static_cast<std::uint32_t>(soup.x_fx.size()));
      // Some coordinates lie on pixel centres and on a common row.
      soup.x_fx.push_back(kind == 0 ? far(random) : (x + offset(random)) & (kind < 5 ? ~127 : ~0));
      soup.y_fx.push_back(kind == 0   ? far(random)
                          : kind == 1 ? y
                                      : (y + offset(random)) & (kind < 5 ? ~127 : ~0));
      soup.z_fx.push_back(kind == 6  ? (random() & 1 ? 1 : -1) * (kMaxVertexDepth >> random() % 40)
                          : kind % 2 ? z + near(random)
                                     : depth(random));
    }
    if (kind == 2) soup.x_fx.back() = kClipped;
    if (kind == 3) soup.indices.back() = soup.indices[soup.indices.size() - 2];
  }
  return soup;
}

/// The plane of triangle i of the batch is make_depth_plane's and depth_base_at's, which depth
/// accuracy tests hold to the rational value.
void expect_plane(const Soup& soup, std::size_t t, const TriangleBatch& batch, std::size_t i) {
  const std::uint32_t* const corner = soup.indices.data() + 3 * t;
  const bool clockwise = (batch.clockwise >> i & 1) != 0;
  const std::array<SnappedVertex, 3> vertices{soup.vertex(corner[0]),
                                              soup.vertex(corner[clockwise ? 2 : 1]),
                                              soup.vertex(corner[clockwise ? 1 : 2])};
  const auto area = static_cast<std::int64_t>(std::abs(batch.area[i]));
  const DepthPlane plane =
      make_depth_plane(vertices, area, std::nullopt, DepthFormat::d24, 0, 0xffffff);
  EXPECT_EQ(static_cast<std::uint64_t>(batch.step_x[i]), plane.step_x) << "triangle " << t;
  EXPECT_EQ(static_cast<std::uint64_t>(batch.step_y[i]), plane.step_y) << "triangle " << t;
  const int x = batch.x0[i] / kTileSize * kTileSize, y = batch.y0[i] / kTileSize * kTileSize;
  EXPECT_EQ(static_cast<std::uint64_t>(batch.base[i]), depth_base_at(vertices, area, x, y))
      << "triangle " << t;
}

TEST_P(FrontEnd, SelectsTrianglesAsPlainCode) {
  std::mt19937 random(2);
  const Soup soup = triangle_soup(20000, random);
  std::size_t kept = 0, clipped = 0, turned_down = 0, planes = 0;
  for (const bool ccw : {false, true}) {
    for (const bool cw : {false, true}) {
      for (const PixelBox& box : {PixelBox{0, 0, 100, 100}, PixelBox{30, 40, 33, 41}}) {
        const TriangleSelector selector = soup.selector(ccw, cw, box);
        std::size_t count = 1;
        for (std::size_t t = 0; t + count <= 20000; t += count, count = count % 64 + 1) {
          TriangleBatch expected, actual;
          const std::uint32_t* const indices = soup.indices.data() + 3 * t;
          scalar_kernels().select_triangles(selector, indices, count, expected);
          kernels(GetParam()).select_triangles(selector, indices, count, actual);
          ASSERT_EQ(actual.clipped, expected.clipped) << "from triangle " << t;
          ASSERT_EQ(actual.kept, expected.kept) << "from triangle " << t;
          ASSERT_EQ(actual.clockwise, expected.clockwise) << "from triangle " << t;
          ASSERT_EQ(actual.small, expected.small) << "from triangle " << t;
          for_each_bit(expected.kept, [&](std::size_t i) {
            EXPECT_EQ(actual.area[i], expected.area[i]);
            EXPECT_EQ(actual.pixels[i], expected.pixels[i]) << "triangle " << t + i;
            EXPECT_EQ(actual.x0[i], expected.x0[i]);
            EXPECT_EQ(actual.y0[i], expected.y0[i]);
            EXPECT_EQ(actual.x1[i], expected.x1[i]);
            EXPECT_EQ(actual.y1[i], expected.y1[i]);
          });
          ASSERT_EQ(actual.planes & ~actual.kept, 0u) << "from triangle " << t;
          for_each_bit(actual.planes, [&](std::size_t i) { expect_plane(soup, t + i, actual, i); });
          const auto number = [](TriangleMask mask) {
            return static_cast<std::size_t>(std::popcount(mask));
          };
          planes += number(actual.planes);
          kept += number(expected.kept);
          clipped += number(expected.clipped);
          turned_down += count - number(expected.kept | expected.clipped);
        }
      }
    }
  }
  EXPECT_GT(kept, 5000u);
  EXPECT_GT(clipped, 5000u);
  EXPECT_GT(turned_down, 50000u);
  EXPECT_GE(planes, GetParam() == Isa::scalar ? 0u : 2000u);
}

/// What is turned down covers nothing, and what is kept and tiny covers something: its pixels.
TEST(SelectTriangles, TurnsDownWhatCoversNoPixel) {
  std::mt19937 random(3);
  const Soup soup = triangle_soup(5000, random);
  const PixelBox box{0, 0, 100, 100};
  const TriangleSelector selector = soup.selector(true, true, box);
  std::size_t tiny = 0;
  for (std::size_t t = 0; t < 5000; ++t) {
    const std::uint32_t* const corner = soup.indices.data() + 3 * t;
    TriangleBatch batch;
    scalar_kernels().select_triangles(selector, corner, 1, batch);
    if (batch.clipped) continue;
    SetupTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k)
      triangle.vertices[k] = {soup.x_fx[corner[k]], soup.y_fx[corner[k]], 0};
    if (triangle.area() < 0) std::swap(triangle.vertices[1], triangle.vertices[2]);
    triangle.x1 = triangle.y1 = 100;
    std::vector<std::pair<int, int>> covered;
    if (triangle.area() != 0)
      for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x)
          if (triangle.covers(x, y)) covered.emplace_back(x, y);
    if (!batch.kept) {
      EXPECT_TRUE(covered.empty()) << "triangle " << t;
      continue;
    }
    if (!batch.small || batch.x1[0] - batch.x0[0] > kTinyBox ||
        batch.y1[0] - batch.y0[0] > kTinyBox) {
      EXPECT_EQ(batch.pixels[0], 0) << "triangle " << t;
      continue;
    }
    std::vector<std::pair<int, int>> pixels;
    for_each_bit(static_cast<std::uint64_t>(batch.pixels[0]), [&](std::size_t i) {
      const int place = static_cast<int>(i);
      pixels.emplace_back(batch.x0[0] + place % kTinyBox, batch.y0[0] + place / kTinyBox);
    });
    EXPECT_FALSE(pixels.empty()) << "triangle " << t;
    EXPECT_EQ(pixels, covered) << "triangle " << t;
    ++tiny;
  }
  EXPECT_GT(tiny, 50u);
}

/// Each pixel of each place in the tile lands in the block and bit that are its own.
TEST(TinyPixels, GoToTheBlocksThatTheyLieIn) {
  std::mt19937 random(4);
  for (int y = 0; y < kTileSize; ++y) {
    for (int x = 0; x < kTileSize; ++x) {
      auto pixels = static_cast<TinyPixels>(random());
      std::array<PixelMask, kBlocksPerTile> expected{}, actual{};
      for (int i = 0; i < kTinyBox * kTinyBox; ++i) {
        const int px = x + i % kTinyBox, py = y + i / kTinyBox;
        if (px >= kTileSize || py >= kTileSize) pixels &= static_cast<TinyPixels>(~(1u << i));
        if ((pixels >> i & 1) == 0) continue;
        expected[static_cast<std::size_t>(py / 8 * 8 + px / 8)] |= PixelMask{1}
                                                                   << (py % 8 * 8 + px % 8);
      }
      for_each_block(pixels, x, y, [&](std::size_t b, PixelMask mask) {
        EXPECT_EQ(actual[b], 0u) << "a block comes twice";
        EXPECT_NE(mask, 0u);
        actual[b] = mask;
      });
      EXPECT_EQ(actual, expected) << x << ", " << y;
    }
  }
}

}  // namespace
