// What must hold of the coverage of every surface, open fans and closed volumes (oracle:
// invariants, each stated at its test).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "closed_meshes.h"
#include "isa_test.h"
#include "random_frames.h"
#include "small_frames.h"

using namespace gnomon::raster;
using namespace gnomon::small_frames;
using namespace gnomon::closed_meshes;
using gnomon::random_frames::Random;

namespace {

class Fan : public gnomon::IsaTest {};
class ClosedVolume : public gnomon::IsaTest {};

struct Point {
  double x = 0, y = 0;
};

/// A random point in units of 1/256 inside a rectangle; one in three on a whole or half unit, so
/// that pixel centres and corners come up.
Point grid_point(Random& random, double x0, double y0, double x1, double y1) {
  const int step = random.chance(0.33f) ? 128 : 1;
  const auto pick = [&](double low, double high) {
    const int low_fx = static_cast<int>(low * 256.0), high_fx = static_cast<int>(high * 256.0);
    return (low_fx + random.integer(0, (high_fx - low_fx) / step) * step) / 256.0;
  };
  const double x = pick(x0, x1);
  return {x, pick(y0, y1)};
}

/// The four corners of a rectangle and random points between them, counter-clockwise.
std::vector<Point> rectangle_rim(Random& random, double x0, double y0, double x1, double y1) {
  std::vector<Point> rim;
  const std::array<Point, 4> corners{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
  for (std::size_t side = 0; side < 4; ++side) {
    const Point& a = corners[side];
    const Point& b = corners[(side + 1) % 4];
    std::vector<Point> between;
    for (int i = random.integer(0, 6); i > 0; --i)
      between.push_back(grid_point(random, std::min(a.x, b.x), std::min(a.y, b.y),
                                   std::max(a.x, b.x), std::max(a.y, b.y)));
    const double dx = b.x - a.x, dy = b.y - a.y;
    std::stable_sort(between.begin(), between.end(), [&](const Point& p, const Point& q) {
      return p.x * dx + p.y * dy < q.x * dx + q.y * dy;
    });
    rim.push_back(a);
    rim.insert(rim.end(), between.begin(), between.end());
  }
  return rim;
}

/// Triangles from the hub to each edge of the closed rim.
std::vector<glm::vec4> fan(const glm::vec4& hub, const std::vector<glm::vec4>& rim) {
  std::vector<glm::vec4> triangles;
  for (std::size_t i = 0; i < rim.size(); ++i)
    for (const glm::vec4& v : {hub, rim[i], rim[(i + 1) % rim.size()]}) triangles.push_back(v);
  return triangles;
}

/// The stencil buffer's rows after the triangles.
std::vector<std::uint8_t> counts(const std::vector<glm::vec4>& triangles, const State& state,
                                 int width, int height, const ExecuteOptions& options) {
  StencilBuffer stencil(width, height);
  Frame frame;
  frame.begin_pass("count", {.stencil = &stencil});
  draw_positions(frame, state, triangles);
  execute(frame, options);
  return stencil.to_rows();
}

}  // namespace

GNOMON_ON_EVERY_ISA(Fan);
GNOMON_ON_EVERY_ISA(ClosedVolume);

// Triangles round a hub whose rim lies on or beyond the target's border cover each pixel once, be
// the hub on the sub-pixel grid, off it or on the rim, and whatever w the vertices have.
TEST_P(Fan, RoundAHubInsideItsRimCoversEachPixelOnce) {
  Random random(5);
  constexpr int kWidth = 90, kHeight = 70;
  for (int round = 0; round < 200; ++round) {
    const double margin = random.chance(0.4f) ? 0.0 : random.integer(1, 1000 * 256) / 256.0;
    const double x1 = kWidth + margin, y1 = kHeight + margin;
    const std::vector<Point> points = rectangle_rim(random, -margin, -margin, x1, y1);
    Point hub = grid_point(random, 0, 0, kWidth, kHeight);
    if (random.chance(0.3f)) hub = {random.real(0, kWidth), random.real(0, kHeight)};
    if (random.chance(0.1f)) hub = points[points.size() / 2];
    const bool perspective = random.chance(0.5f);
    const auto clip = [&](const Point& p) {
      const float w = perspective ? random.real(0.01f, 20.0f) : 1.0f;
      return w * at_window(p.x, p.y, kWidth, kHeight, random.real(0.1f, 0.9f));
    };
    std::vector<glm::vec4> rim;
    for (const Point& p : points) rim.push_back(clip(p));
    const auto rows = counts(fan(clip(hub), rim), counting(), kWidth, kHeight, options(round));
    ASSERT_EQ(std::count(rows.begin(), rows.end(), 1), kWidth * kHeight) << "round " << round;
  }
}

// The same where the rim is cut off: at or behind the plane of the eye, at infinity, or outside the
// guard band. Cut pieces that turn over in the snap count negative, so signs are counted.
TEST_P(Fan, ThatIsClippedCoversEachPixelOnce) {
  Random random(6);
  constexpr int kWidth = 90, kHeight = 70;
  for (int round = 0; round < 200; ++round) {
    const glm::vec4 hub = at_window(random.real(0, kWidth), random.real(0, kHeight), kWidth,
                                    kHeight, random.real(0.0f, 1.0f));
    const int kind = random.integer(0, 2);
    const float far_away = random.real(500.0f, 1e6f);
    std::vector<glm::vec4> rim;
    for (const Point& p : rectangle_rim(random, -2, -2, 2, 2)) {
      // As seen from the hub every direction is there, so nothing on the w > 0 side is left out.
      const float w = kind == 0 ? 1.0f : kind == 1 ? 0.0f : -random.real(0.0f, 3.0f);
      const float reach = kind == 0 ? far_away : 1.0f;
      rim.push_back({reach * static_cast<float>(p.x) + hub.x * w,
                     reach * static_cast<float>(p.y) + hub.y * w, random.real(-1.0f, 1.0f), w});
    }
    const bool reversed = random.chance(0.5f);
    if (reversed) std::reverse(rim.begin(), rim.end());
    State state = signed_counting();
    state.depth_clamp = true;
    const auto rows = counts(fan(hub, rim), state, kWidth, kHeight, options(round));
    ASSERT_EQ(std::count(rows.begin(), rows.end(), reversed ? 255 : 1), kWidth * kHeight)
        << "round " << round;
  }
}

// Round any closed line, one that crosses itself too, the signed count of a fan is how often the
// line winds round the pixel: it does not depend on where the hub is.
TEST_P(Fan, RoundAnyHubCountsHowOftenItsRimWindsRoundThePixel) {
  Random random(7);
  constexpr int kWidth = 90, kHeight = 70;
  int largest = 0;
  for (int round = 0; round < 100; ++round) {
    std::vector<glm::vec4> rim;
    for (int i = random.integer(3, 14); i > 0; --i) {
      const Point p = grid_point(random, -60, -60, kWidth + 60, kHeight + 60);
      rim.push_back(random.real(0.1f, 9.0f) * at_window(p.x, p.y, kWidth, kHeight));
    }
    std::vector<std::uint8_t> first;
    for (int i = 0; i < 3; ++i) {
      const Point p{random.real(-90, 2 * kWidth), random.real(-70, 2 * kHeight)};
      const auto rows = counts(fan(at_window(p.x, p.y, kWidth, kHeight), rim), signed_counting(),
                               kWidth, kHeight, options(round));
      if (i == 0) first = rows;
      ASSERT_EQ(rows, first) << "round " << round;
    }
    for (const std::uint8_t s : first) largest = std::max(largest, s < 128 ? s : 256 - s);
  }
  EXPECT_GT(largest, 1);
}

namespace {

/// clip_from_eye of an eye at the origin that looks along -z: near plane at 0.05, far plane at 100.
glm::mat4 perspective(float focal_length) {
  constexpr float kNear = 0.05f, kFar = 100.0f;
  glm::mat4 clip_from_eye(0.0f);
  clip_from_eye[0][0] = clip_from_eye[1][1] = focal_length;
  clip_from_eye[2][2] = (kNear + kFar) / (kNear - kFar);
  clip_from_eye[2][3] = -1.0f;
  clip_from_eye[3][2] = 2.0f * kNear * kFar / (kNear - kFar);
  return clip_from_eye;
}

/// A mesh in front of the plane of the eye, somewhere in view; `nearest` is how close it may come.
ClosedMesh mesh_in_view(Random& random, float nearest) {
  const float radius = random.real(0.05f, 3.0f);
  const float distance = nearest + radius + random.real(0.0f, 6.0f);
  const float x = distance * random.real(-1.0f, 1.0f), y = distance * random.real(-1.0f, 1.0f);
  return random_mesh(random, {x, y, -distance}, radius);
}

/// A point or a direction beside or behind the eye.
glm::vec4 light_behind(Random& random) {
  const float x = random.real(-5.0f, 5.0f), y = random.real(-5.0f, 5.0f);
  return {x, y, random.real(0.0f, 5.0f), random.chance(0.5f) ? 1.0f : 0.0f};
}

/// A point or a direction such that the mesh's first triangle is between light and eye.
glm::vec4 light_beyond(Random& random, const ClosedMesh& mesh) {
  glm::vec3 on_triangle(0.0f);
  for (std::size_t i = 0; i < 3; ++i)
    on_triangle += glm::vec3(mesh.positions[mesh.indices[i]]) / 3.0f;
  return {random.real(1.5f, 4.0f) * on_triangle, random.chance(0.5f) ? 1.0f : 0.0f};
}

Draw draw_of(const ClosedMesh& mesh, const State& state, const glm::mat4& clip_from_model) {
  return {.state = state,
          .mesh = {.positions = mesh.positions, .indices = mesh.indices},
          .clip_from_model = clip_from_model};
}

std::vector<std::uint8_t> counts_of(const ClosedMesh& mesh, const State& state,
                                    const glm::mat4& clip_from_model,
                                    const ExecuteOptions& options) {
  StencilBuffer stencil(90, 70);
  Frame frame;
  frame.begin_pass("closed mesh", {.stencil = &stencil});
  frame.draw(draw_of(mesh, state, clip_from_model));
  execute(frame, options);
  return stencil.to_rows();
}

bool all_are(const std::vector<std::uint8_t>& rows, int value) {
  return std::all_of(rows.begin(), rows.end(), [value](std::uint8_t s) { return s == value; });
}

}  // namespace

// Without a depth test every line of sight leaves a closed surface as often as it enters it, once
// more if the eye is inside: all pixels count the same, wherever the surface is cut.
TEST_P(ClosedVolume, CountsTheSameAtEveryPixelHoweverItIsCut) {
  int enclosing = 0;
  Random random(17);
  State state = signed_counting();
  state.depth_clamp = true;
  for (int round = 0; round < 300; ++round) {
    ClosedMesh mesh{{}, {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2}};
    for (int i = 0; i < 4; ++i) {
      // Some vertices behind the eye or at infinity: the surface is cut by w > 0 and the guard band
      // only.
      const float w = random.chance(0.2f) ? 0.0f : random.real(-1.0f, 2.0f);
      const float x = random.real(-3.0f, 3.0f), y = random.real(-3.0f, 3.0f);
      mesh.positions.push_back({x, y, random.real(-3.0f, 3.0f), w});
    }
    const auto rows = counts_of(mesh, state, glm::mat4(1.0f), options(round));
    ASSERT_TRUE(rows[0] == 0 || rows[0] == 1 || rows[0] == 255) << "round " << round;
    ASSERT_TRUE(all_are(rows, rows[0])) << "round " << round;
    enclosing += rows[0] != 0;
  }
  EXPECT_GT(enclosing, 5);
  EXPECT_LT(enclosing, 150);
}

// The eye outside, the sum is zero at every pixel: nearer than the near plane, outside the view,
// and for surfaces that cut through themselves.
TEST_P(ClosedVolume, SeenFromOutsideSumsToZero) {
  Random random(18);
  int touched = 0;
  State state = signed_counting(), unsigned_state = counting();
  state.depth_clamp = unsigned_state.depth_clamp = true;
  for (int round = 0; round < 200; ++round) {
    const ClosedMesh mesh = mesh_in_view(random, 0.001f);
    const glm::mat4 clip_from_model = perspective(random.real(0.3f, 3.0f));
    ASSERT_TRUE(all_are(counts_of(mesh, state, clip_from_model, options(round)), 0))
        << "round " << round;
    touched += !all_are(counts_of(mesh, unsigned_state, clip_from_model, options(round)), 0);
  }
  EXPECT_GT(touched, 100);
}

// The shadow volumes of a mesh, extruded to infinity: all pixels count the same, namely in how many
// of them the eye is; none if the light is not in front of the eye and the mesh is.
TEST_P(ClosedVolume, ExtrudedToInfinityCountsTheVolumesThatTheEyeIsIn) {
  Random random(19);
  int enclosing = 0;
  State state = signed_counting();
  state.depth_clamp = true;
  for (int round = 0; round < 120; ++round) {
    const bool outside = round % 2 == 0;
    const ClosedMesh mesh = mesh_in_view(random, 0.001f);
    const ClosedMesh volumes =
        shadow_volumes(mesh, outside ? light_behind(random) : light_beyond(random, mesh));
    const auto rows =
        counts_of(volumes, state, perspective(random.real(0.3f, 3.0f)), options(round));
    ASSERT_TRUE(all_are(rows, outside ? 0 : rows[0])) << "round " << round;
    enclosing += rows[0] != 0;
  }
  EXPECT_GT(enclosing, 50);
}

// Where near and far planes cut nothing off, front and back faces in front of the stored depth and
// those behind it together sum to zero: counting those behind (z-fail) equals counting those in
// front (z-pass), for any depth buffer, comparison and offset.
TEST_P(ClosedVolume, CountsTheSameByZFailAndByZPass) {
  Random random(20);
  int nonzero = 0;
  for (int round = 0; round < 150; ++round) {
    const bool clamp = random.chance(0.5f);
    ClosedMesh mesh = mesh_in_view(random, clamp ? 0.001f : 0.06f);
    if (clamp && random.chance(0.5f)) mesh = shadow_volumes(mesh, light_behind(random));
    const auto format = random.chance(0.5f) ? DepthFormat::d24 : DepthFormat::d16;
    DepthBuffer depth(90, 70, format);
    // Depths as they come to lie behind this projection: most of them close to the far end.
    for (int y = 0; y < 70; ++y)
      for (int x = 0; x < 90; ++x)
        depth.plane().at(x, y) =
            depth.max_value() -
            static_cast<std::uint32_t>(random.integer(0, static_cast<int>(depth.max_value() / 32)));
    StencilBuffer pass(90, 70), fail(90, 70);
    StencilState z_pass, z_fail;
    z_pass.front.pass = z_fail.back.depth_fail = StencilOp::incr_wrap;
    z_pass.back.pass = z_fail.front.depth_fail = StencilOp::decr_wrap;
    State state{.color = ColorState::off()};
    state.depth = DepthState{static_cast<CompareFunc>(random.integer(0, 7)), false};
    state.depth_clamp = clamp;
    if (random.chance(0.5f))
      state.polygon_offset = PolygonOffset{random.real(-2.0f, 2.0f), random.real(-9.0f, 9.0f)};
    const glm::mat4 clip_from_model = perspective(random.real(0.3f, 3.0f));
    Frame frame;
    frame.begin_pass("z-pass", {.depth = &depth, .stencil = &pass});
    state.stencil = z_pass;
    frame.draw(draw_of(mesh, state, clip_from_model));
    frame.begin_pass("z-fail", {.depth = &depth, .stencil = &fail});
    state.stencil = z_fail;
    frame.draw(draw_of(mesh, state, clip_from_model));
    execute(frame, options(round));
    ASSERT_EQ(fail.to_rows(), pass.to_rows()) << "round " << round;
    nonzero += !all_are(pass.to_rows(), 0);
  }
  EXPECT_GT(nonzero, 30);
}
