#include "golden/differences.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "golden/hash.h"

namespace gnomon::golden {
namespace {

/// Whether the bits differ, and by how much the values do.
struct PixelDifference {
  bool differs = false;
  double amount = 0.0;
};

PixelDifference at_pixel(const raster::ColorBuffer& a, const raster::ColorBuffer& b, int x, int y) {
  PixelDifference result;
  if (a.format() == raster::ColorFormat::rgba8) {
    const raster::Rgba8 p = a.rgba8().at(x, y), q = b.rgba8().at(x, y);
    result.differs = p != q;
    for (std::size_t i = 0; i < 4; ++i)
      result.amount = std::max(result.amount, std::abs(double{1} * p[i] - q[i]));
  } else {
    const glm::vec4 p = a.rgba32f().at(x, y), q = b.rgba32f().at(x, y);
    // Bits, so that -0 and 0 differ and a NaN is itself.
    result.differs = std::memcmp(&p, &q, sizeof p) != 0;
    for (int i = 0; i < 4; ++i)
      result.amount = std::max(result.amount, std::abs(double{p[i]} - double{q[i]}));
  }
  return result;
}

PixelDifference at_pixel(const raster::DepthBuffer& a, const raster::DepthBuffer& b, int x, int y) {
  const double amount = std::abs(double{1} * a.at(x, y) - b.at(x, y));
  return {amount != 0.0, amount};
}

PixelDifference at_pixel(const raster::StencilBuffer& a, const raster::StencilBuffer& b, int x,
                         int y) {
  const double amount = std::abs(double{1} * a.at(x, y) - b.at(x, y));
  return {amount != 0.0, amount};
}

}  // namespace

Difference difference(const raster::Buffer& got, const raster::Buffer& expected,
                      const std::function<void(int x, int y)>& at) {
  Difference sum;
  std::visit(
      [&]<class B>(const B& a) {
        const B& b = std::get<B>(expected);
        for (int y = 0; y < a.height(); ++y)
          for (int x = 0; x < a.width(); ++x) {
            const PixelDifference d = at_pixel(a, b, x, y);
            sum.pixels += d.differs;
            sum.largest = std::max(sum.largest, d.amount);
            if (d.differs) at(x, y);
          }
      },
      got);
  return sum;
}

std::string sentences(const raster::RecordedFrame& got, const raster::RecordedFrame& expected) {
  std::ostringstream text;
  for (std::size_t i = 0; i < got.buffers.size(); ++i) {
    const BufferHash what = hash_of(got.buffers[i]);
    const Difference d = difference(got.buffers[i], expected.buffers[i]);
    text << what.kind << ' ' << what.format << ' ' << what.width << 'x' << what.height << ": "
         << d.pixels << " pixels differ, by at most " << d.largest << '\n';
  }
  return text.str();
}

}  // namespace gnomon::golden
