// The pinhole view of a distorted photograph and the way back. Oracles: the lens's own projection,
// and closed forms.
#include "ar/composite.h"

#include <gtest/gtest.h>

#include <cmath>

#include <glm/matrix.hpp>

#include "ar/false_color.h"

namespace gnomon::ar {
namespace {

CameraModel camera(bool distorted) {
  CameraModel model{80, 60, 75.0, 74.0, 40.3, 28.9};
  if (distorted) model.distortion = {-0.12, 0.03, 0.001, -0.002};
  return model;
}

Image gradient(int width, int height) {
  Image image{width, height, 3, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int v : {2 * x, 3 * y, x + y})
        image.pixels.push_back(static_cast<std::uint8_t>(v));
  return image;
}

/// A colour buffer that holds the picture with alpha 0, as after step 1 of the method.
raster::ColorBuffer drawn_from(const Image& image) {
  raster::ColorBuffer buffer(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* c = image.at(x, y);
      buffer.rgba8().at(x, image.height - 1 - y) = {c[0], c[1], c[2], 0};
    }
  return buffer;
}

}  // namespace

TEST(PinholeView, PlacesWorldPointsWhereTheLensDoes) {
  const Lens lens(camera(true));
  for (const int samples : {1, 3, 4}) {
    const PinholeView view(lens, samples);
    const glm::dmat4 pose(1.0);
    const pipeline::Camera pinhole = view.camera(pose, 0.1, 50.0);
    int checked = 0;
    for (int y = 0; y < 60; y += 7)
      for (int x = 0; x < 80; x += 7) {
        const std::optional<glm::dvec2> n = lens.undistort({x, y});
        ASSERT_TRUE(n.has_value());
        const glm::vec4 clip =
            pinhole.clip_from_world * glm::vec4(glm::vec3(glm::dvec3(*n, 1.0) * 2.5), 1.0f);
        const double u = (clip.x / clip.w * 0.5 + 0.5) * view.width() - 0.5;
        const double v = view.height() - ((clip.y / clip.w * 0.5 + 0.5) * view.height()) - 0.5;
        // float32 clip coordinates: 2^-23 of a view of some 500 pixels.
        EXPECT_NEAR(u, view.view_from_photo(x, y).x, 1e-3);
        EXPECT_NEAR(v, view.view_from_photo(x, y).y, 1e-3);
        EXPECT_GT(u, -0.5);
        EXPECT_LT(u, view.width() - 0.5);
        ++checked;
      }
    EXPECT_EQ(checked, 9 * 12);
  }
}

TEST(PinholeView, WithoutALensAndWithOneSampleIsThePhotograph) {
  const PinholeView view{Lens(camera(false)), 1};
  EXPECT_TRUE(view.is_identity());
  EXPECT_EQ(view.width(), 80);
  EXPECT_EQ(view.height(), 60);
  const Image photo = gradient(80, 60);
  EXPECT_EQ(view.resample(photo).pixels, photo.pixels);
  EXPECT_EQ(view.view_from_photo(7, 9), glm::vec2(7, 9));
}

TEST(PinholeView, TakesTwoSamplesWithoutDistortionAndFourWithIt) {
  EXPECT_EQ(PinholeView(Lens(camera(false)), 0).samples(), 2);
  EXPECT_EQ(PinholeView(Lens(camera(true)), 0).samples(), 4);
}

TEST(Composite, OfAnUntouchedDrawingIsThePhotographToTheByte) {
  const Image photo = gradient(80, 60);
  for (const bool distorted : {false, true})
    for (const int samples : {1, 2, 4}) {
      const PinholeView view{Lens(camera(distorted)), samples};
      const Image resampled = view.resample(photo);
      EXPECT_EQ(composite(view, photo, resampled, drawn_from(resampled).to_rgba8_rows()).pixels,
                photo.pixels);
    }
}

TEST(Composite, ThroughAnIdentityViewIsTheDrawing) {
  const Image photo = gradient(80, 60);
  const PinholeView view{Lens(camera(false)), 1};
  raster::ColorBuffer drawn = drawn_from(photo);
  for (int x = 0; x < 80; ++x) {
    for (std::size_t c = 0; c < 3; ++c) drawn.rgba8().at(x, 10)[c] /= 2;  // a shadow
    drawn.rgba8().at(x, 30) = {200, 100, 50, 255};                        // an object
  }
  const Image out = composite(view, photo, photo, drawn.to_rgba8_rows());
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_EQ(out.at(x, y)[c], drawn.rgba8().at(x, 59 - y)[c]) << x << ' ' << y;
}

TEST(Composite, AShadowScalesThePhotographThroughAnyLens) {
  // Oracle: photograph times 0.6; the drawing is rounded to 8 bits a view pixel, so the factor is
  // off by up to 0.5 / value.
  Image photo = gradient(80, 60);
  for (std::uint8_t& v : photo.pixels) v = static_cast<std::uint8_t>(60 + v / 2);
  const PinholeView view{Lens(camera(true)), 4};
  const Image resampled = view.resample(photo);
  Image darkened = resampled;
  for (std::uint8_t& v : darkened.pixels) v = static_cast<std::uint8_t>(std::lround(0.6 * v));
  const Image out = composite(view, photo, resampled, drawn_from(darkened).to_rgba8_rows());
  for (std::size_t i = 0; i < out.pixels.size(); ++i)
    ASSERT_NEAR(out.pixels[i], 0.6 * photo.pixels[i], 1.5);
}

TEST(Composite, CoveredShareIsTheAreaUnderThePixel) {
  const PinholeView view{Lens(camera(false)), 4};
  // The left half of the view is set: 40 photograph pixels wide.
  std::vector<std::uint8_t> rows(static_cast<std::size_t>(view.width()) * view.height() * 4);
  for (int v = 0; v < view.height(); ++v)
    for (int u = 0; u < 40 * 4 + 1; ++u)
      rows[4 * (static_cast<std::size_t>(v) * view.width() + u)] = 255;
  EXPECT_EQ(covered_share(view, rows, 0, 39, 20), 1.0);
  EXPECT_NEAR(covered_share(view, rows, 0, 40, 20), 0.25, 1e-5);
  EXPECT_EQ(covered_share(view, rows, 0, 41, 20), 0.0);
  EXPECT_EQ(covered_share(view, rows, 1, 39, 20), 0.0);
}

TEST(FalseColor, TellsSmallCountsApart) {
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < a; ++b) {
      const auto x = stencil_color(static_cast<std::uint8_t>(a)),
                 y = stencil_color(static_cast<std::uint8_t>(b));
      int distance = 0;
      for (std::size_t c = 0; c < 3; ++c) distance += std::abs(x[c] - y[c]);
      EXPECT_GT(distance, 25) << a << ' ' << b;
    }
}

TEST(FalseColor, LegendStandsBesideThePicture) {
  const Image picture = stencil_picture(50, 40, std::vector<std::uint8_t>(50 * 40, 1));
  EXPECT_GT(picture.width, 50);
  const auto color = stencil_color(1);
  EXPECT_TRUE(std::equal(color.begin(), color.end(), picture.at(49, 39)));
}

}  // namespace gnomon::ar
