#include "raster/buffers.h"

#include <algorithm>

#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

/// Row-wise values from the tile-linear plane, block by block.
template <class T, class Out, class Convert>
std::vector<Out> rows(const TiledPlane<T>& plane, Convert convert) {
  std::vector<Out> out(static_cast<std::size_t>(plane.width()) * plane.height());
  for (int y0 = 0; y0 < plane.height(); y0 += kBlockSize)
    for (int x0 = 0; x0 < plane.width(); x0 += kBlockSize) {
      const T* block = &plane.at(x0, y0);
      for (int y = y0; y < std::min(y0 + kBlockSize, plane.height()); ++y)
        for (int x = x0; x < std::min(x0 + kBlockSize, plane.width()); ++x)
          out[static_cast<std::size_t>(y) * plane.width() + x] =
              convert(block[(y - y0) * kBlockSize + (x - x0)]);
    }
  return out;
}

template <class T>
std::vector<T> rows(const TiledPlane<T>& plane) {
  return rows<T, T>(plane, [](const T& value) { return value; });
}

}  // namespace

ColorBuffer::ColorBuffer(int width, int height, ColorFormat format)
    : width_(width), height_(height), format_(format) {
  if (format == ColorFormat::rgba8)
    plane_ = TiledPlane<Rgba8>(width, height);
  else
    plane_ = TiledPlane<glm::vec4>(width, height);
}

glm::vec4 ColorBuffer::at(int x, int y) const {
  if (format_ == ColorFormat::rgba32f) return rgba32f().at(x, y);
  return to_floats(rgba8().at(x, y));
}

TiledPlane<Rgba8>& ColorBuffer::rgba8() {
  require(format_ == ColorFormat::rgba8, "rgba8() is asked of an RGBA8 buffer");
  return std::get<TiledPlane<Rgba8>>(plane_);
}

const TiledPlane<Rgba8>& ColorBuffer::rgba8() const {
  return const_cast<ColorBuffer*>(this)->rgba8();
}

TiledPlane<glm::vec4>& ColorBuffer::rgba32f() {
  require(format_ == ColorFormat::rgba32f, "rgba32f() is asked of an RGBA32F buffer");
  return std::get<TiledPlane<glm::vec4>>(plane_);
}

const TiledPlane<glm::vec4>& ColorBuffer::rgba32f() const {
  return const_cast<ColorBuffer*>(this)->rgba32f();
}

std::vector<std::uint8_t> ColorBuffer::to_rgba8_rows() const {
  const std::vector<Rgba8> pixels =
      format_ == ColorFormat::rgba8
          ? rows(rgba8())
          : rows<glm::vec4, Rgba8>(rgba32f(), [](const glm::vec4& c) { return to_rgba8(c); });
  std::vector<std::uint8_t> bytes(pixels.size() * 4);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    std::copy_n(pixels[i].begin(), 4, bytes.begin() + static_cast<std::ptrdiff_t>(4 * i));
  return bytes;
}

DepthBuffer::DepthBuffer(int width, int height, DepthFormat format)
    : format_(format), plane_(width, height) {
  for (int ty = 0; ty < plane_.tiles_y(); ++ty)
    for (int tx = 0; tx < plane_.tiles_x(); ++tx)
      std::fill_n(plane_.tile(tx, ty), kPixelsPerTile, max_value());
  ranges_.resize(static_cast<std::size_t>(plane_.tiles_x()) * plane_.tiles_y());
}

TiledPlane<std::uint32_t>& DepthBuffer::plane() {
  ++version_;
  return plane_;
}

DepthTile DepthBuffer::tile(int tile_x, int tile_y) {
  DepthRanges& ranges = ranges_[static_cast<std::size_t>(tile_y) * plane_.tiles_x() + tile_x];
  if (ranges.version != version_) {
    ranges.forget_all();
    ranges.version = version_;
  }
  return {plane_.tile(tile_x, tile_y), &ranges};
}

std::uint32_t DepthBuffer::max_value() const { return max_depth(format_); }

std::vector<std::uint32_t> DepthBuffer::to_rows() const { return rows(plane_); }

std::vector<std::uint8_t> StencilBuffer::to_rows() const { return rows(plane_); }

}  // namespace gnomon::raster
