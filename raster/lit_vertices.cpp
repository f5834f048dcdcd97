#include "raster/lit_vertices.h"

#include "raster/interpolate.h"
#include "raster/lit_terms.h"

namespace gnomon::raster {

bool lights_vertices(const Draw& draw) {
  const Lit* lit = std::get_if<Lit>(&draw.shading);
  return lit && lit->at_vertices && draw.state.cull != Cull::front_and_back;
}

void LitVertices::begin(const Draw& draw) {
  draw_ = &draw;
  const Lit& lit = std::get<Lit>(draw.shading);
  terms_ = make_lit(lit);
  lights_.clear();
  for (const Light& light : lit.lights) lights_.push_back(make_light(light));
  const bool has_front = !lit.two_sided || draw.state.cull != Cull::front;
  const bool has_back = lit.two_sided && draw.state.cull != Cull::back;
  front_.resize(has_front ? vertex_count() : 0);
  back_.resize(has_back ? vertex_count() : 0);
}

void LitVertices::run(const Kernels& kernels, std::size_t first, std::size_t last) {
  const MeshView& mesh = draw_->mesh;
  if (kernels.light_vertices) {
    const Lighting lighting{&terms_, lights_.data(), static_cast<int>(lights_.size())};
    const LitAttributes attributes{mesh.positions.data() + first, mesh.normals.data() + first,
                                   mesh.colors.empty() ? nullptr : mesh.colors.data() + first};
    kernels.light_vertices(lighting, attributes, last - first,
                           front_.empty() ? nullptr : front_.data() + first,
                           back_.empty() ? nullptr : back_.data() + first);
    return;
  }
  const Lit& lit = std::get<Lit>(draw_->shading);
  for (std::size_t i = first; i < last; ++i) {
    Fragment vertex = vertex_attributes(mesh, lit, i);
    if (!front_.empty()) front_[i] = light_vertex(lit, vertex);
    vertex.front_facing = false;
    if (!back_.empty()) back_[i] = light_vertex(lit, vertex);
  }
}

VertexColors LitVertices::colors() const {
  const bool differ = std::get<Lit>(draw_->shading).two_sided;
  return {front_, differ ? back_ : front_};
}

}  // namespace gnomon::raster
