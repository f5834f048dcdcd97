// Brings what was drawn in the pinhole view back into the photograph's own pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "ar/image.h"
#include "ar/pinhole_view.h"
#include "pipeline/finish_picture.h"
#include "raster/buffers.h"

namespace gnomon::ar {

/// The photograph with the drawing in it. A pixel under which no view pixel changed keeps its
/// bytes. Elsewhere, over the view pixels that a photograph's pixel spans: the drawn colour where a
/// virtual object is visible (alpha, by its share), and the photograph's own value times drawn /
/// resampled for the rest, so that a shadow keeps the photograph's detail and noise. Through an
/// identity view this is the drawn picture. `drawn_rows` are r, g, b, a from the bottom row, as
/// ColorBuffer::to_rgba8_rows gives them; the result is the same for every number of threads.
/// Preconditions: they have the view's size, `resampled` is view.resample(photograph).
Image composite(const PinholeView& view, const Image& photograph, const Image& resampled,
                const std::vector<std::uint8_t>& drawn_rows, int threads = 0);

/// The same of differential shadows by share: a photograph's pixel is finished with each of the
/// view pixels that it spans, and the mean taken; the photograph is not resampled. Preconditions:
/// `drawn` has the view's size, `finish` takes by share.
Image composite(const PinholeView& view, const Image& photograph, const raster::ColorBuffer& drawn,
                const pipeline::PictureFinish& finish, int threads = 0);

/// The share of a photograph's pixel, as a square of the view, where a channel of the view's rows
/// (r, g, b, a from the bottom row) is 255 and not 0; view pixels that the square cuts count by the
/// part inside. 0 where the lens images nothing.
double covered_share(const PinholeView& view, const std::vector<std::uint8_t>& rgba_rows,
                     std::size_t channel, int x, int y);

/// A plane of the view (rows from the bottom, as buffers give them) at the photograph's pixel
/// centres, rows from the top; `outside` where the lens images nothing.
template <class T>
std::vector<T> at_photo_pixels(const PinholeView& view, const std::vector<T>& rows, T outside) {
  std::vector<T> out;
  out.reserve(static_cast<std::size_t>(view.photo_width()) * view.photo_height());
  for (int y = 0; y < view.photo_height(); ++y)
    for (int x = 0; x < view.photo_width(); ++x) {
      const glm::vec2 at = view.view_from_photo(x, y);
      if (!(at.x > -0.5f && at.y > -0.5f && at.x < static_cast<float>(view.width()) - 0.5f &&
            at.y < static_cast<float>(view.height()) - 0.5f)) {
        out.push_back(outside);
        continue;
      }
      const int u = static_cast<int>(at.x + 0.5f), v = static_cast<int>(at.y + 0.5f);
      out.push_back(rows[static_cast<std::size_t>(view.height() - 1 - v) * view.width() + u]);
    }
  return out;
}

}  // namespace gnomon::ar
