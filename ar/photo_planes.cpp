#include "ar/photo_planes.h"

#include <array>

#include "ar/composite.h"
#include "ar/false_color.h"
#include "raster/executor.h"

namespace gnomon::ar {

Image mask_at_photo(const PinholeView& view, const std::vector<std::uint8_t>& rgba_rows,
                    std::size_t channel, int threads) {
  constexpr std::size_t kRows = 16;
  Image out{view.photo_width(), view.photo_height(), 1, {}};
  out.pixels.resize(static_cast<std::size_t>(out.width) * out.height);
  raster::for_each_chunk(static_cast<std::size_t>(out.height), kRows, threads,
                         [&](std::size_t first, std::size_t last) {
                           for (std::size_t y = first; y < last; ++y) {
                             const int row = static_cast<int>(y);
                             for (int x = 0; x < out.width; ++x)
                               *out.at(x, row) =
                                   covered_share(view, rgba_rows, channel, x, row) >= 0.5 ? 255 : 0;
                           }
                         });
  return out;
}

Image color_at_photo(const PinholeView& view, const raster::ColorBuffer& color) {
  const std::vector<std::uint8_t> rows = color.to_rgba8_rows();
  std::vector<std::array<std::uint8_t, 3>> plane;
  plane.reserve(rows.size() / 4);
  for (std::size_t i = 0; i < rows.size(); i += 4)
    plane.push_back({rows[i], rows[i + 1], rows[i + 2]});
  Image out{view.photo_width(), view.photo_height(), 3, {}};
  for (const auto& c : at_photo_pixels(view, plane, {}))
    out.pixels.insert(out.pixels.end(), c.begin(), c.end());
  return out;
}

Image stencil_at_photo(const PinholeView& view, const raster::StencilBuffer& stencil) {
  return stencil_picture(view.photo_width(), view.photo_height(),
                         at_photo_pixels<std::uint8_t>(view, stencil.to_rows(), 0));
}

Image depth_at_photo(const PinholeView& view, const raster::DepthBuffer& depth) {
  return depth_picture(view.photo_width(), view.photo_height(),
                       at_photo_pixels(view, depth.to_rows(), depth.max_value()),
                       depth.max_value());
}

}  // namespace gnomon::ar
