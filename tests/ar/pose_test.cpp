// Oracles: corners projected from known poses, and properties of the filter in closed form.
#include "ar/pose.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "ar/pose_filter.h"

namespace gnomon::ar {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

const CameraModel kCamera{640,
                          480,
                          618.4,
                          617.1,
                          322.7,
                          236.8,
                          LensKind::brown_conrady,
                          {-0.092, 0.038, 1e-3, -5e-4, 0.0}};

/// Faces the camera, then tilts about the picture's x and y and turns about its own normal.
glm::dmat4 facing(glm::dvec3 at, double tilt_x_deg, double tilt_y_deg, double turn_deg) {
  glm::dmat4 m = glm::translate(glm::dmat4(1.0), at);
  m = glm::rotate(m, tilt_x_deg * kDegree, glm::dvec3(1, 0, 0));
  m = glm::rotate(m, tilt_y_deg * kDegree, glm::dvec3(0, 1, 0));
  m = glm::rotate(m, std::numbers::pi, glm::dvec3(1, 0, 0));
  return glm::rotate(m, turn_deg * kDegree, glm::dvec3(0, 0, 1));
}

TagView view_of(const Lens& lens, const glm::dmat4& camera_from_body,
                const glm::dmat4& body_from_tag, double size_m) {
  TagView view{tag_corners_m(size_m), {}};
  for (std::size_t c = 0; c < 4; ++c) {
    view.body_m[c] = glm::dvec3(body_from_tag * glm::dvec4(view.body_m[c], 1.0));
    view.corners_px[c] =
        lens.project(glm::dvec3(camera_from_body * glm::dvec4(view.body_m[c], 1.0))).value();
  }
  return view;
}

void shake(TagView& view, std::mt19937& random, double sigma_px) {
  std::normal_distribution<double> noise(0.0, sigma_px);
  for (glm::dvec2& p : view.corners_px) p += glm::dvec2(noise(random), noise(random));
}

TEST(Pose, OneTagIsRecoveredThroughADistortingLens) {
  const Lens lens(kCamera);
  for (const double tilt : {-60.0, -25.0, 10.0, 40.0, 70.0}) {
    for (const double turn : {0.0, 77.0, 180.0, -120.0}) {
      const glm::dmat4 truth = facing({0.15, -0.1, 0.8}, tilt, 0.4 * tilt, turn);
      const auto fits =
          tag_poses(lens, view_of(lens, truth, glm::dmat4(1.0), 0.06).corners_px, 0.06);
      ASSERT_FALSE(fits.empty());
      EXPECT_LT(fits[0].rms_px, 1e-5);
      EXPECT_LT(rotation_between_rad(fits[0].camera_from_body, truth), 1e-5);
      EXPECT_LT(glm::distance(fits[0].camera_from_body[3], truth[3]), 1e-6);
    }
  }
}

TEST(Pose, OneTagIsRecoveredThroughAFisheyeLens) {
  const Lens lens({640, 480, 300, 300, 320, 240, LensKind::fisheye, {0.05, -0.02, 0.004, -0.001}});
  const glm::dmat4 truth = facing({0.7, 0.3, 0.6}, 30, -20, 50);
  const auto fits = tag_poses(lens, view_of(lens, truth, glm::dmat4(1.0), 0.1).corners_px, 0.1);
  ASSERT_FALSE(fits.empty());
  EXPECT_LT(rotation_between_rad(fits[0].camera_from_body, truth), 1e-5);
  EXPECT_LT(glm::distance(fits[0].camera_from_body[3], truth[3]), 1e-6);
}

TEST(Pose, ATiltedTagHasItsMirroredPoseAsSecond) {
  const Lens lens(kCamera);
  const glm::dmat4 truth = facing({0.0, 0.0, 1.0}, 25, 0, 0);
  const auto fits = tag_poses(lens, view_of(lens, truth, glm::dmat4(1.0), 0.06).corners_px, 0.06);
  ASSERT_EQ(fits.size(), 2u);
  EXPECT_LT(fits[0].chi2, fits[1].chi2);
  // Mirrored tilt: about twice 25 degrees away.
  EXPECT_NEAR(rotation_between_rad(fits[0].camera_from_body, fits[1].camera_from_body) / kDegree,
              50, 5);
}

TEST(Pose, AWrongStartIsGivenUpWhenTheErrorsSaySo) {
  const Lens lens(kCamera);
  std::mt19937 random(5);
  const glm::dmat4 truth = facing({0.0, 0.0, 0.8}, 35, 0, 0);
  PoseChooser chooser;
  std::optional<glm::dmat4> prior = facing({0.0, 0.0, 0.8}, -35, 0, 0);
  int wrong = 0;
  for (int frame = 0; frame < 30; ++frame) {
    TagView view = view_of(lens, truth, glm::dmat4(1.0), 0.06);
    shake(view, random, 0.2);
    const auto fits = body_poses(lens, std::span(&view, 1), {}, prior);
    prior = fits[chooser.choose(fits, prior)].camera_from_body;
    if (rotation_between_rad(*prior, truth) > 20 * kDegree) ++wrong;
  }
  EXPECT_LT(wrong, 10);
  EXPECT_LT(rotation_between_rad(*prior, truth), 20 * kDegree);
}

std::vector<glm::dmat4> four_places() {
  std::vector<glm::dmat4> places;
  for (const glm::dvec3 at :
       {glm::dvec3(-0.3, 0.2, 0), {0.3, 0.2, 0}, {0.3, -0.2, 0}, {-0.3, -0.2, 0}}) {
    places.push_back(glm::translate(glm::dmat4(1.0), at));
  }
  return places;
}

TEST(Pose, AMovedTagAmongFourIsLeftOutWhicheverItIs) {
  const Lens lens(kCamera);
  const glm::dmat4 truth = facing({0.0, 0.05, 1.2}, 40, 10, 5);
  for (std::size_t wrong = 0; wrong < 4; ++wrong) {
    std::mt19937 random(2);
    std::vector<TagView> views;
    for (const glm::dmat4& place : four_places())
      views.push_back(view_of(lens, truth, place, 0.08));
    for (TagView& view : views) shake(view, random, 0.1);
    for (glm::dvec3& p : views[wrong].body_m) p += glm::dvec3(0.05, -0.03, 0.0);
    const auto fits = body_poses(lens, views);
    ASSERT_FALSE(fits.empty());
    for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(fits[0].used[v], v != wrong) << wrong;
    EXPECT_LT(glm::distance(fits[0].camera_from_body[3], truth[3]), 0.002);
    EXPECT_LT(rotation_between_rad(fits[0].camera_from_body, truth), 0.15 * kDegree);
  }
}

TEST(Pose, SeveralTagsAreMoreExactThanTheBestOfThem) {
  const Lens lens(kCamera);
  const glm::dmat4 truth = facing({0.0, 0.05, 1.2}, 40, 10, 5);
  std::mt19937 random(9);
  double together = 0.0, alone = 0.0;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<TagView> views;
    for (const glm::dmat4& place : four_places())
      views.push_back(view_of(lens, truth, place, 0.08));
    for (TagView& view : views) shake(view, random, 0.2);
    together += glm::distance(body_poses(lens, views)[0].camera_from_body[3], truth[3]);
    alone +=
        glm::distance(body_poses(lens, std::span(views).first(1))[0].camera_from_body[3], truth[3]);
  }
  EXPECT_LT(together, 0.25 * alone);
}

TEST(Pose, DegenerateCornersGiveNoPoseOrAFiniteOne) {
  const Lens lens(kCamera);
  const std::vector<TagCorners> bad{{glm::dvec2(10, 10), {10, 10}, {10, 10}, {10, 10}},
                                    {glm::dvec2(10, 10), {20, 10}, {30, 10}, {40, 10}},
                                    {glm::dvec2(NAN, 10), {20, 10}, {20, 20}, {10, 20}},
                                    {glm::dvec2(1e9, 10), {20, 10}, {20, 20}, {10, 20}},
                                    {glm::dvec2(10, 10), {20, 20}, {20, 10}, {10, 20}}};
  for (const TagCorners& corners : bad) {
    for (const PoseFit& fit : tag_poses(lens, corners, 0.05)) {
      for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) EXPECT_TRUE(std::isfinite(fit.camera_from_body[c][r]));
      }
    }
  }
  EXPECT_TRUE(body_poses(lens, {}).empty());
}

TEST(Pose, RigidInverseAndAxesAreExact) {
  const glm::dmat4 m = facing({1, 2, 3}, 10, 20, 30);
  const glm::dmat4 product = m * rigid_inverse(m);
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(product[c][r], c == r ? 1.0 : 0.0, 1e-14);
  }
  EXPECT_EQ(opengl_from_opencv_axes() * opengl_from_opencv_axes(), glm::dmat4(1.0));
}

TEST(PoseFilter, TheFirstPosePassesAndARestingOneStays) {
  PoseFilter filter({});
  const glm::dmat4 m = facing({1, 2, 3}, 10, 20, 30);
  EXPECT_EQ(filter.filter(m, 0.0), m);
  for (int i = 1; i < 10; ++i) {
    const glm::dmat4 f = filter.filter(m, 0.1 * i);
    EXPECT_LT(glm::distance(f[3], m[3]), 1e-12);
    EXPECT_LT(rotation_between_rad(f, m), 1e-7);
  }
}

TEST(PoseFilter, AtConstantCutOffAStepFollowsTheFirstOrderLowPass) {
  PoseFilter filter({.min_cutoff_hz = 1.0, .beta_per_m = 0.0, .beta_per_rad = 0.0});
  glm::dmat4 m(1.0);
  filter.filter(m, 0.0);
  m[3][0] = 1.0;
  // Weight of the new value: 2 pi f dt / (1 + 2 pi f dt).
  const double a = 2 * std::numbers::pi * 0.1 / (1 + 2 * std::numbers::pi * 0.1);
  double expected = 0.0;
  for (int i = 1; i < 8; ++i) {
    expected += a * (1.0 - expected);
    EXPECT_NEAR(filter.filter(m, 0.1 * i)[3][0], expected, 1e-12);
  }
}

TEST(PoseFilter, TremblingIsHalvedAtRestAndAFastMoveHardlyLags) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.0005);
  PoseFilter still({}), moving({});
  double in = 0.0, out = 0.0, lag = 0.0;
  glm::dmat4 last_in(1.0), last_out(1.0);
  for (int i = 0; i < 600; ++i) {
    const double t = i / 30.0;
    glm::dmat4 m(1.0);
    m[3] = glm::dvec4(noise(random), noise(random), noise(random), 1.0);
    const glm::dmat4 f = still.filter(m, t);
    in += glm::distance(m[3], last_in[3]);
    out += glm::distance(f[3], last_out[3]);
    last_in = m;
    last_out = f;
    glm::dmat4 fast(1.0);
    fast[3][0] = 0.5 * t;
    const glm::dmat4 g = moving.filter(fast, t);
    if (i > 60) lag = std::max(lag, std::abs(g[3][0] - fast[3][0]));
  }
  EXPECT_LT(out, 0.5 * in);
  // At 0.5 m/s the cut-off is 101 Hz: lag (1 - a) / a of the 16.7 mm between frames, 0.8 mm.
  EXPECT_LT(lag, 0.001);
}

TEST(PoseFilter, TimeThatStandsStillOrRunsBackStartsAnew) {
  PoseFilter filter({});
  const glm::dmat4 a = facing({0, 0, 1}, 0, 0, 0), b = facing({1, 0, 1}, 10, 0, 0);
  filter.filter(a, 1.0);
  EXPECT_EQ(filter.filter(b, 1.0), b);
  EXPECT_EQ(filter.filter(a, 0.5), a);
  EXPECT_EQ(filter.filter(b, NAN), b);
}

}  // namespace
}  // namespace gnomon::ar
