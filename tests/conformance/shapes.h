// What the grids draw with: triangles in window coordinates, owned by the frame, and the state's
// values in lists to loop over.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "grid.h"
#include "raster/frame.h"

namespace gnomon::conformance {

inline constexpr std::array<raster::CompareFunc, 8> kFuncs{
    raster::CompareFunc::never,         raster::CompareFunc::less,
    raster::CompareFunc::equal,         raster::CompareFunc::less_equal,
    raster::CompareFunc::greater,       raster::CompareFunc::not_equal,
    raster::CompareFunc::greater_equal, raster::CompareFunc::always};
inline constexpr std::array<raster::StencilOp, 8> kOps{
    raster::StencilOp::keep,      raster::StencilOp::zero,      raster::StencilOp::replace,
    raster::StencilOp::incr,      raster::StencilOp::incr_wrap, raster::StencilOp::decr,
    raster::StencilOp::decr_wrap, raster::StencilOp::invert};
inline constexpr std::array<raster::DepthFormat, 2> kDepthFormats{raster::DepthFormat::d24,
                                                                  raster::DepthFormat::d16};

std::string text(raster::CompareFunc func);
std::string text(raster::StencilOp op);
std::string text(raster::DepthFormat format);
std::string text(Size size);

/// A mesh of triangles, three vertices each. Attributes are empty or one a vertex.
struct Triangles {
  std::vector<glm::vec4> positions;
  std::vector<glm::vec4> colors = {};
  std::vector<glm::vec2> texcoords = {};
  std::vector<glm::vec3> normals = {};
};

/// Records `draw` with these triangles as its mesh; the frame keeps them.
void record_draw(raster::Frame& frame, raster::Draw draw, Triangles triangles);

/// Clip-space position of window coordinates (x, y) in pixels, depth in [0, 1], under the default
/// viewport and depth range.
glm::vec4 at_window(double x, double y, Size size, double depth = 0.5);

/// Two counter-clockwise triangles from (x0, y0) to (x1, y1) in window coordinates.
std::vector<glm::vec4> quad(double x0, double y0, double x1, double y1, Size size,
                            double depth = 0.5);
/// A quad over the whole viewport, z in normalised device coordinates.
std::vector<glm::vec4> full_quad(float z_ndc = 0.0f);
/// The same triangles wound the other way round.
std::vector<glm::vec4> reversed(std::vector<glm::vec4> triangles);

}  // namespace gnomon::conformance
