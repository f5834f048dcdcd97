#include "ar/pinhole_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "ar/error.h"
#include "raster/check.h"
#include "raster/tiled_plane.h"

namespace gnomon::ar {

namespace {

/// Enough for smooth edges; a distorted lens also wants its pixels found to an eighth.
constexpr int kSamples = 2, kSamplesOfADistortedLens = 4;
constexpr int kMostSamples = 8;
/// A view needs memory for three buffers and two maps; this many pixels take about 1.5 GB.
constexpr double kMostViewPixels = 64.0e6;

bool distorts(const CameraModel& camera) {
  return camera.lens == LensKind::fisheye ||
         std::any_of(camera.distortion.begin(), camera.distortion.end(),
                     [](double k) { return k != 0.0; });
}

struct Extent {
  glm::dvec2 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
};

/// Bounds of the photograph's pixel areas in normalised coordinates. Looks at every pixel: a lens
/// need not be widest at the border.
Extent imaged_extent(const Lens& lens) {
  Extent extent;
  for (int y = 0; y <= lens.camera().height; ++y)
    for (int x = 0; x <= lens.camera().width; ++x)
      if (const std::optional<glm::dvec2> n = lens.undistort({x - 0.5, y - 0.5})) {
        extent.low = glm::min(extent.low, *n);
        extent.high = glm::max(extent.high, *n);
      }
  return extent;
}

}  // namespace

PinholeView::PinholeView(const Lens& lens, int samples) {
  const CameraModel& camera = lens.camera();
  raster::require(samples >= 0 && samples <= kMostSamples,
                  "samples a pixel are 0 (automatic) to 8");
  raster::require(camera.width >= 1 && camera.height >= 1, "the lens's camera has a size");
  photo_width_ = camera.width;
  photo_height_ = camera.height;
  const bool distorted = distorts(camera);
  samples_ = samples > 0 ? samples : (distorted ? kSamplesOfADistortedLens : kSamples);

  Extent extent{{(-0.5 - camera.cx) / camera.fx, (-0.5 - camera.cy) / camera.fy},
                {(camera.width - 0.5 - camera.cx) / camera.fx,
                 (camera.height - 0.5 - camera.cy) / camera.fy}};
  if (distorted) extent = imaged_extent(lens);
  if (!(extent.low.x < extent.high.x && extent.low.y < extent.high.y))
    throw InputError("camera: the lens images no pixel of the picture");
  const glm::dvec2 size = extent.high - extent.low;
  for (;; --samples_) {
    focal_ = glm::dvec2(camera.fx, camera.fy) * static_cast<double>(samples_);
    const glm::dvec2 pixels = glm::round(size * focal_ * 1048576.0) / 1048576.0;
    if (std::max(pixels.x, pixels.y) <= raster::kMaxTargetSize &&
        pixels.x * pixels.y <= kMostViewPixels) {
      width_ = std::max(1, static_cast<int>(std::ceil(pixels.x)));
      height_ = std::max(1, static_cast<int>(std::ceil(pixels.y)));
      break;
    }
    if (samples_ == 1)
      throw InputError("camera: the lens's field of view is too wide for a pinhole picture (" +
                       std::to_string(pixels.x) + " x " + std::to_string(pixels.y) + " pixels)");
  }
  // The first pixel's centre is half a view pixel inside the extent.
  center_ = -extent.low * focal_ - 0.5;
  identity_ = !distorted && samples_ == 1;
  build_maps(lens);
}

void PinholeView::build_maps(const Lens& lens) {
  const auto nan = std::numeric_limits<float>::quiet_NaN();
  view_from_photo_.assign(static_cast<std::size_t>(photo_width_) * photo_height_, {nan, nan});
  for (int y = 0; y < photo_height_; ++y)
    for (int x = 0; x < photo_width_; ++x) {
      glm::vec2& at = view_from_photo_[static_cast<std::size_t>(y) * photo_width_ + x];
      if (identity_)
        at = {static_cast<float>(x), static_cast<float>(y)};
      else if (const std::optional<glm::dvec2> n = lens.undistort({x, y}))
        if (const glm::dvec2 p = *n * focal_ + center_;
            p.x >= -1.0 && p.y >= -1.0 && p.x <= width_ && p.y <= height_)
          at = glm::vec2(p);
    }
  nearest_.assign(view_from_photo_.size(), {-1, -1});
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    const glm::vec2 at = view_from_photo_[i];
    if (std::isnan(at.x)) continue;
    const int u = static_cast<int>(std::floor(at.x + 0.5f)),
              v = static_cast<int>(std::floor(at.y + 0.5f));
    if (u >= 0 && v >= 0 && u < width_ && v < height_)
      nearest_[i] = {static_cast<std::int16_t>(u), static_cast<std::int16_t>(height_ - 1 - v)};
  }
  if (identity_) return;
  const CameraModel& camera = lens.camera();
  photo_x_.resize(static_cast<std::size_t>(width_) * height_);
  photo_y_.resize(photo_x_.size());
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const glm::dvec2 n = (glm::dvec2(x, y) - center_) / focal_;
      const std::optional<glm::dvec2> pixel = lens.project({n, 1.0});
      const std::size_t i = static_cast<std::size_t>(y) * width_ + x;
      photo_x_[i] = pixel ? static_cast<float>(pixel->x) : static_cast<float>(camera.cx);
      photo_y_[i] = pixel ? static_cast<float>(pixel->y) : static_cast<float>(camera.cy);
    }
}

pipeline::Camera PinholeView::camera(const glm::dmat4& world_from_camera, double near_m,
                                     double far_m) const {
  raster::require(near_m > 0.0 && near_m < far_m, "near and far satisfy 0 < near < far");
  // Camera axes are OpenCV's, w is z: window x = focal x / z + center + 1/2, window y counts from
  // the bottom.
  glm::dmat4 clip_from_camera(0.0);
  clip_from_camera[0][0] = 2.0 * focal_.x / width_;
  clip_from_camera[2][0] = 2.0 * (center_.x + 0.5) / width_ - 1.0;
  clip_from_camera[1][1] = -2.0 * focal_.y / height_;
  clip_from_camera[2][1] = 1.0 - 2.0 * (center_.y + 0.5) / height_;
  clip_from_camera[2][2] = (far_m + near_m) / (far_m - near_m);
  clip_from_camera[3][2] = -2.0 * far_m * near_m / (far_m - near_m);
  clip_from_camera[2][3] = 1.0;
  pipeline::Camera camera;
  camera.clip_from_world = glm::mat4(clip_from_camera * glm::inverse(world_from_camera));
  camera.eye_world = glm::vec3(world_from_camera[3]);
  camera.width = width_;
  camera.height = height_;
  return camera;
}

Image PinholeView::resample(const Image& photograph) const {
  raster::require(photograph.channels == 3 && photograph.width == photo_width_ &&
                      photograph.height == photo_height_,
                  "the photograph has three channels and the camera's size");
  if (identity_) return photograph;
  Image out{width_, height_, 3, std::vector<std::uint8_t>(std::size_t{3} * width_ * height_)};
  const cv::Mat source(photo_height_, photo_width_, CV_8UC3,
                       const_cast<std::uint8_t*>(photograph.pixels.data()));
  cv::Mat target(height_, width_, CV_8UC3, out.pixels.data());
  const cv::Mat map_x(height_, width_, CV_32F, const_cast<float*>(photo_x_.data()));
  const cv::Mat map_y(height_, width_, CV_32F, const_cast<float*>(photo_y_.data()));
  cv::remap(source, target, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return out;
}

}  // namespace gnomon::ar
