// A draw's triangles on their way to the tiles: vertices, set-up triangles in chunks, bins. Draws
// of one group whose triangles are set up alike share them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "raster/geometry.h"
#include "raster/kernels.h"
#include "raster/tile_bins.h"

namespace gnomon::raster {

/// Mesh triangles that are set up and binned together, by one thread; apart from what other threads
/// write, so that no cache line goes to and fro.
struct alignas(128) TriangleChunk {
  SetupTriangles set_up;
  TileBins bins;
};

class DrawGeometry {
 public:
  /// Begins anew with a draw's geometry; memory is kept.
  void begin(const DrawSetup& setup);
  /// The draw's triangles are set up as these are.
  bool serves(const DrawSetup& setup) const;

  std::size_t vertex_count() const { return setup_.draw->mesh.positions.size(); }
  std::size_t chunk_count() const { return chunk_count_; }

  /// First step: vertices [first, last) to the window.
  void run_vertices(const Kernels& kernels, std::size_t first, std::size_t last);
  /// Second step, after all vertices: set-up and bins of one chunk.
  void run_chunk(const Kernels& kernels, std::size_t chunk);

  /// `colors`: of the draw that the triangles are drawn by.
  TriangleSource source_of(const TriangleChunk& chunk, const VertexColors& colors) const {
    return {vertices_.inverse_w, chunk.set_up.pieces, colors};
  }
  std::span<const TriangleChunk> chunks() const { return std::span(chunks_).first(chunk_count_); }

 private:
  DrawSetup setup_;
  DrawVertices vertices_;
  std::vector<TriangleChunk> chunks_;
  std::size_t chunk_count_ = 0, triangles_per_chunk_ = 0;
};

}  // namespace gnomon::raster
