// The ideal pinhole picture that the rasterizer draws for a photograph taken through a real lens,
// and the way between the two. The view covers all that the photograph shows, with `samples`
// pinhole pixels a photograph's pixel along x and y at the picture's centre. Without distortion and
// with one sample the two pictures are the same, pixel by pixel. Invariant: the photograph stays in
// its own geometry; it is resampled only to be seen under the drawing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "ar/camera.h"
#include "ar/image.h"
#include "pipeline/scene.h"

namespace gnomon::ar {

class PinholeView {
 public:
  /// samples: 1 to 8, or 0 for what the lens needs: 2 without distortion (smooth edges), 4 with it
  /// (a photograph's pixel is then looked up within an eighth of a pixel). Reduced so far that the
  /// view stays within the rasterizer's largest target. Precondition: the lens's camera has a size.
  /// Errors: InputError when the lens images no pixel of the photograph, or so wide a field that no
  /// pinhole picture can hold it.
  PinholeView(const Lens& lens, int samples);

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }
  /// The photograph's size.
  int photo_width() const { return photo_width_; }
  int photo_height() const { return photo_height_; }
  /// Both pictures are the same pixel by pixel.
  bool is_identity() const { return identity_; }

  /// The pinhole camera of this view at a pose (OpenCV's axes); near and far in metres.
  pipeline::Camera camera(const glm::dmat4& world_from_camera, double near_m, double far_m) const;

  /// Where a photograph's pixel centre lies in the view, in pixels from the top left pixel's
  /// centre; NaN where the lens images nothing. What is not NaN lies in the view or at most a pixel
  /// beside it.
  glm::vec2 view_from_photo(int x, int y) const {
    return view_from_photo_[static_cast<std::size_t>(y) * photo_width_ + x];
  }

  /// The view's pixel nearest to that, columns from the left and rows from the bottom as in
  /// buffers;
  /// (-1, -1) where there is none.
  std::array<std::int16_t, 2> nearest(int x, int y) const {
    return nearest_[static_cast<std::size_t>(y) * photo_width_ + x];
  }

  /// The photograph as the pinhole camera sees it (bilinear; its border goes on outside). Three
  /// channels in, three out.
  Image resample(const Image& photograph) const;

 private:
  void build_maps(const Lens& lens);

  int width_ = 0, height_ = 0, samples_ = 1, photo_width_ = 0, photo_height_ = 0;
  bool identity_ = false;
  /// view pixel = focal * normalised + center.
  glm::dvec2 focal_{1.0}, center_{0.0};
  std::vector<glm::vec2> view_from_photo_;
  std::vector<std::array<std::int16_t, 2>> nearest_;
  /// The photograph's pixel at each view pixel, as x and y planes.
  std::vector<float> photo_x_, photo_y_;
};

}  // namespace gnomon::ar
