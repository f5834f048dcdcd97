// The edges of a draw's triangles in the window: what is drawn over a picture to show a mesh, and
// of a shadow volume its silhouette, sides and caps.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/frame.h"

namespace gnomon::apps::inspector {

enum class EdgeKind : std::int32_t { mesh, front_cap, side, back_cap, silhouette };

/// Window coordinates in 1/256 pixel from the bottom left corner.
struct WireEdge {
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  EdgeKind kind = EdgeKind::mesh;
};

/// Edges of the triangles as they are rasterized: clipped, culled, snapped; each once a kind.
/// Silhouette edges are those of a volume's sides (pipeline::ShadowVolume::parts) whose triangles
/// are not cut.
std::vector<WireEdge> wireframe(const raster::Draw& draw, const raster::Targets& targets);

}  // namespace gnomon::apps::inspector
