#include "raster/draw_geometry.h"

#include <algorithm>

namespace gnomon::raster {

namespace {

/// Large meshes have large chunks, because a chunk's bins can have an entry a tile.
std::size_t chunk_size(std::size_t triangles) { return triangles < (1u << 16) ? 1024 : 8192; }

template <class T>
bool same(std::span<T> a, std::span<T> b) {
  return a.data() == b.data() && a.size() == b.size();
}

bool same_box(const PixelBox& a, const PixelBox& b) {
  return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

}  // namespace

void DrawGeometry::begin(const DrawSetup& setup) {
  setup_ = setup;
  vertices_.resize(vertex_count());
  const std::size_t triangles = setup.draw->mesh.indices.size() / 3;
  triangles_per_chunk_ = chunk_size(triangles);
  chunk_count_ = (triangles + triangles_per_chunk_ - 1) / triangles_per_chunk_;
  if (chunks_.size() < chunk_count_) chunks_.resize(chunk_count_);
}

bool DrawGeometry::serves(const DrawSetup& setup) const {
  const Draw &mine = *setup_.draw, &other = *setup.draw;
  return same(mine.mesh.positions, other.mesh.positions) &&
         same(mine.mesh.indices, other.mesh.indices) &&
         mine.clip_from_model == other.clip_from_model && same_box(setup_.box, setup.box) &&
         setup_.viewport == setup.viewport && setup_.depth_format == setup.depth_format &&
         mine.state.depth_range == other.state.depth_range &&
         mine.state.depth_clamp == other.state.depth_clamp &&
         mine.state.polygon_offset == other.state.polygon_offset &&
         mine.state.cull == other.state.cull && mine.state.front_face == other.state.front_face;
}

void DrawGeometry::run_vertices(const Kernels& kernels, std::size_t first, std::size_t last) {
  const Draw& draw = *setup_.draw;
  kernels.transform(draw.clip_from_model, draw.mesh.positions.data() + first, last - first,
                    vertices_.clip.data() + first);
  project_vertices(kernels, setup_, vertices_, first, last);
}

void DrawGeometry::run_chunk(const Kernels& kernels, std::size_t chunk) {
  const std::size_t triangles = setup_.draw->mesh.indices.size() / 3;
  const std::size_t first = chunk * triangles_per_chunk_;
  TriangleChunk& out = chunks_[chunk];
  out.set_up.clear();
  set_up_triangles(kernels, setup_, vertices_, first,
                   std::min(triangles_per_chunk_, triangles - first), out.set_up);
  out.bins.fill(out.set_up.triangles);
}

}  // namespace gnomon::raster
