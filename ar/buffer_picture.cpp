#include "ar/buffer_picture.h"

#include "ar/false_color.h"

namespace gnomon::ar {

namespace {

template <class T>
std::vector<T> rows_from_top(const std::vector<T>& from_bottom, int width, int height) {
  std::vector<T> rows;
  rows.reserve(from_bottom.size());
  for (int y = height - 1; y >= 0; --y)
    rows.insert(rows.end(), from_bottom.begin() + static_cast<std::ptrdiff_t>(y) * width,
                from_bottom.begin() + static_cast<std::ptrdiff_t>(y + 1) * width);
  return rows;
}

}  // namespace

Image buffer_picture(const raster::ColorBuffer& color) {
  const std::vector<std::uint8_t> rgba =
      rows_from_top(color.to_rgba8_rows(), 4 * color.width(), color.height());
  Image out{color.width(), color.height(), 3, {}};
  out.pixels.reserve(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size(); ++i)
    if (i % 4 != 3) out.pixels.push_back(rgba[i]);
  return out;
}

Image buffer_picture(const raster::DepthBuffer& depth) {
  return depth_picture(depth.width(), depth.height(),
                       rows_from_top(depth.to_rows(), depth.width(), depth.height()),
                       depth.max_value());
}

Image buffer_picture(const raster::StencilBuffer& stencil) {
  return stencil_picture(stencil.width(), stencil.height(),
                         rows_from_top(stencil.to_rows(), stencil.width(), stencil.height()));
}

Image buffer_picture(const raster::Buffer& buffer) {
  return std::visit([](const auto& plane) { return buffer_picture(plane); }, buffer);
}

}  // namespace gnomon::ar
