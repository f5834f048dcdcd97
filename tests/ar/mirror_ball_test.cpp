// Oracle: the law of reflection on a sphere in closed form.
#include "ar/mirror_ball.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace gnomon::ar {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "coordinate " << c;
}

TEST(MirrorBall, TheMiddleReflectsTheViewerAndTheRimLetsPass) {
  const MirrorBall ball{{0, 0, -2}, 0.5, glm::dvec3(1.0)};
  const auto middle = reflect(ball, {{0, 0, 0}, {0, 0, -1}});
  ASSERT_TRUE(middle);
  expect_near(middle->ray.origin, {0, 0, -1.5}, 1e-15);
  expect_near(middle->ray.direction, {0, 0, 1}, 1e-15);
  EXPECT_DOUBLE_EQ(middle->cos_incidence, 1.0);
  // The tangent from the eye leaves the axis by asin(r / d).
  const double tangent = std::asin(0.25);
  const auto direction = [](double a) { return glm::dvec3(std::sin(a), 0, -std::cos(a)); };
  EXPECT_FALSE(reflect(ball, {{0, 0, 0}, direction(tangent + 1e-6)}));
  const auto rim = reflect(ball, {{0, 0, 0}, direction(tangent - 1e-9)});
  ASSERT_TRUE(rim);
  expect_near(rim->ray.direction, direction(tangent), 1e-3);
}

TEST(MirrorBall, ParallelRaysTurnByTwiceTheNormalsAngle) {
  const MirrorBall ball{{1, 2, 3}, 0.05, glm::dvec3(0.9)};
  for (const double share : {0.1, 0.5, std::sqrt(0.5), 0.9}) {
    const auto hit = reflect(ball, {{1 + 0.05 * share, 2, 13}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    const double turn = 2.0 * std::asin(share);
    expect_near(hit->ray.direction, {std::sin(turn), 0, std::cos(turn)}, 1e-12);
    EXPECT_NEAR(hit->cos_incidence, std::cos(turn / 2.0), 1e-12);
  }
}

TEST(MirrorBall, BehindOrInsideTheViewerNothingIsReflected) {
  const MirrorBall ball{{0, 0, 2}, 0.5, glm::dvec3(1.0)};
  EXPECT_FALSE(reflect(ball, {{0, 0, 0}, {0, 0, -1}}));
  EXPECT_FALSE(reflect(ball, {{0, 0, 2.1}, {0, 0, 1}}));
}

// Alhazen's problem, checked by reflecting the way back.
TEST(MirrorBall, ThePointThatShowsAPlaceReflectsTheSightToIt) {
  const MirrorBall ball{{0.1, 0.5, -0.2}, 0.05, glm::dvec3(1.0)};
  const glm::dvec3 eye(-0.16, 0.56, 0.1);
  for (const glm::dvec3 place :
       {glm::dvec3(1.5, 2.0, 0.7), glm::dvec3(-2.0, 1.5, -0.25), glm::dvec3(0.3, 2.6, 0.1),
        glm::dvec3(0.1, 0.0, -0.2), glm::dvec3(1.5, 0.4, -0.5)}) {
    const auto shown = mirror_point(ball, eye, glm::dvec4(place, 1.0));
    ASSERT_TRUE(shown);
    const glm::dvec3 point = *shown;
    EXPECT_NEAR(glm::length(point - ball.center_m), ball.radius_m, 1e-12);
    const auto hit = reflect(ball, {eye, glm::normalize(point - eye)});
    ASSERT_TRUE(hit);
    expect_near(hit->ray.direction, glm::normalize(place - point), 1e-7);
    // At infinity: the direction itself.
    const glm::dvec3 far = glm::normalize(place - ball.center_m);
    const auto other = mirror_point(ball, eye, glm::dvec4(far, 0.0));
    ASSERT_TRUE(other);
    const auto back = reflect(ball, {eye, glm::normalize(*other - eye)});
    ASSERT_TRUE(back);
    expect_near(back->ray.direction, far, 1e-7);
  }
}

TEST(MirrorBall, NoPointShowsWhatTheBallHides) {
  const MirrorBall ball{{0, 0, -1}, 0.1, glm::dvec3(1.0)};
  const glm::dvec3 eye(0.0);
  EXPECT_FALSE(mirror_point(ball, eye, {0, 0, -5, 1}));
  EXPECT_FALSE(mirror_point(ball, eye, {0.1, 0.2, -5, 1}));
  // Just beside the ball's cone of shadow the rim shows it.
  EXPECT_TRUE(mirror_point(ball, eye, {0.8, 0, -5, 1}));
}

TEST(MirrorBall, ItsOutlineIsTheConeOfSight) {
  const Lens lens(pinhole_camera(640, 480, 500.0));
  const glm::dmat4 at_origin(1.0);  // Looks along +z.
  const MirrorBall ball{{0, 0, 1}, 0.1, glm::dvec3(1.0)};
  const auto outline = ball_outline(ball, lens, at_origin, 640, 480);
  ASSERT_TRUE(outline);
  EXPECT_NEAR(outline->radius_px, 500.0 * std::tan(std::asin(0.1)), 0.01);
  EXPECT_EQ(outline->inside, 1.0);
  EXPECT_LE(outline->x0, 319.5 - outline->radius_px);
  EXPECT_GE(outline->x1, 319.5 + outline->radius_px);
}

TEST(MirrorBall, OutsideOfThePictureItHasNoPixels) {
  const Lens lens(pinhole_camera(640, 480, 500.0));
  const glm::dmat4 at_origin(1.0);
  const auto aside = ball_outline({{5, 0, 1}, 0.1, glm::dvec3(1.0)}, lens, at_origin, 640, 480);
  EXPECT_TRUE(!aside || aside->x0 >= aside->x1);
  EXPECT_FALSE(ball_outline({{0, 0, -1}, 0.1, glm::dvec3(1.0)}, lens, at_origin, 640, 480));
  EXPECT_FALSE(ball_outline({{0, 0, 0.05}, 0.1, glm::dvec3(1.0)}, lens, at_origin, 640, 480));
  // Half of it: the middle of the ball is on the picture's edge.
  const auto half =
      ball_outline({{319.5 / 500.0 * 2.0, 0, 2}, 0.1, glm::dvec3(1.0)}, lens, at_origin, 640, 480);
  ASSERT_TRUE(half);
  EXPECT_NEAR(half->inside, 0.5, 0.02);
  EXPECT_EQ(half->x1, 640);
}

TEST(MirrorBall, PixelRaysFollowThePoseAndTheLens) {
  CameraModel model = pinhole_camera(640, 480, 600.0);
  model.distortion = {-0.1, 0.04, 0.0, 0.0, 0.0};
  const Lens lens(model);
  glm::dmat4 pose(1.0);
  pose[0] = {0, 0, -1, 0};
  pose[2] = {1, 0, 0, 0};
  pose[3] = {1, 2, 3, 1};
  const glm::dvec3 point(4.0, 2.4, 2.5);
  const glm::dvec3 seen(glm::inverse(pose) * glm::dvec4(point, 1.0));
  const auto pixel = lens.project(seen);
  ASSERT_TRUE(pixel);
  const auto ray = pixel_ray(lens, pose, *pixel);
  ASSERT_TRUE(ray);
  expect_near(ray->origin, {1, 2, 3}, 0.0);
  expect_near(ray->direction, glm::normalize(point - glm::dvec3(1, 2, 3)), 1e-7);
}

}  // namespace
}  // namespace gnomon::ar
