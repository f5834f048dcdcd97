// The vertices of a draw that is lit at vertices (Lit::at_vertices): the lighting equation once a
// vertex and side, before triangles are looked at.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec4.hpp>

#include "raster/frame.h"
#include "raster/geometry.h"
#include "raster/kernels.h"

namespace gnomon::raster {

/// The draw's fragments take their colour from lit vertices.
/// Precondition: its colour reaches a target.
bool lights_vertices(const Draw& draw);

class LitVertices {
 public:
  /// Begins anew with a draw that is lit at vertices and outlives the work; memory is kept.
  void begin(const Draw& draw);

  std::size_t vertex_count() const { return draw_->mesh.positions.size(); }
  /// Lights vertices [first, last).
  void run(const Kernels& kernels, std::size_t first, std::size_t last);

  /// Valid until it begins anew; without those of a side that is culled.
  VertexColors colors() const;

 private:
  const Draw* draw_ = nullptr;
  LitTerms terms_{};
  std::vector<LitLight> lights_;
  /// Those of the back are filled only if sides differ.
  std::vector<glm::vec4> front_, back_;
};

}  // namespace gnomon::raster
