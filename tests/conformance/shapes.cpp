#include "shapes.h"

#include <memory>
#include <numeric>
#include <utility>

namespace gnomon::conformance {

using namespace gnomon::raster;

std::string text(CompareFunc func) {
  constexpr std::array<std::string_view, 8> kNames{
      "never", "less", "equal", "less_equal", "greater", "not_equal", "greater_equal", "always"};
  return std::string(kNames[static_cast<std::size_t>(func)]);
}

std::string text(StencilOp op) {
  constexpr std::array<std::string_view, 8> kNames{"keep",      "zero", "replace",   "incr",
                                                   "incr_wrap", "decr", "decr_wrap", "invert"};
  return std::string(kNames[static_cast<std::size_t>(op)]);
}

std::string text(DepthFormat format) { return format == DepthFormat::d24 ? "D24" : "D16"; }

std::string text(Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

void record_draw(Frame& frame, Draw draw, Triangles triangles) {
  struct Kept {
    Triangles triangles;
    std::vector<std::uint32_t> indices;
  };
  auto kept = std::make_shared<Kept>();
  kept->triangles = std::move(triangles);
  kept->indices.resize(kept->triangles.positions.size());
  std::iota(kept->indices.begin(), kept->indices.end(), 0u);
  frame.keep(kept);
  const Triangles& t = kept->triangles;
  draw.mesh = {t.positions, kept->indices, t.normals, t.colors, t.texcoords};
  frame.draw(std::move(draw));
}

glm::vec4 at_window(double x, double y, Size size, double depth) {
  return {static_cast<float>(2.0 * x / size.width - 1.0),
          static_cast<float>(2.0 * y / size.height - 1.0), static_cast<float>(2.0 * depth - 1.0),
          1.0f};
}

std::vector<glm::vec4> quad(double x0, double y0, double x1, double y1, Size size, double depth) {
  const glm::vec4 a = at_window(x0, y0, size, depth), b = at_window(x1, y0, size, depth),
                  c = at_window(x1, y1, size, depth), d = at_window(x0, y1, size, depth);
  return {a, b, c, a, c, d};
}

std::vector<glm::vec4> full_quad(float z_ndc) {
  const glm::vec4 a{-1, -1, z_ndc, 1}, b{1, -1, z_ndc, 1}, c{1, 1, z_ndc, 1}, d{-1, 1, z_ndc, 1};
  return {a, b, c, a, c, d};
}

std::vector<glm::vec4> reversed(std::vector<glm::vec4> triangles) {
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
    std::swap(triangles[i + 1], triangles[i + 2]);
  return triangles;
}

}  // namespace gnomon::conformance
