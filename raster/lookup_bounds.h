// Which triangles a flat colour's depth lookup leaves no mark of, found before they are drawn:
// those whose comparisons all fail, where a share of 0 leaves the stored colour as it is. The map's
// texels are known by the least and greatest of each of its 8x8 blocks (as raster/depth_ranges.h
// has them of targets).
#pragma once

#include <array>
#include <limits>
#include <memory_resource>
#include <optional>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "raster/frame.h"
#include "raster/kernels.h"

namespace gnomon::raster {

/// The ranges of the map's blocks, row after row; none if to find them costs more than they save.
std::pmr::vector<LookupRange> lookup_ranges(const Draw& draw, const DepthLookup& lookup,
                                            const Kernels& kernels,
                                            std::pmr::memory_resource& memory);

/// Where the draw's lookup gives 0, its source of 0 changes nothing that is stored; in float32, if
/// weights of vertices are not negative. `flat` is the draw's shading.
bool zero_keeps(const Draw& draw, const Flat& flat, ColorFormat format);

/// A box round positions of the mesh's triangles, whose eight corners they lie between.
class PositionBox {
 public:
  void add(const glm::vec4& position) {
    least_ = glm::min(least_, position);
    greatest_ = glm::max(greatest_, position);
  }
  /// Absent if w is not the same for all, or there are none.
  std::optional<std::array<glm::vec4, 8>> corners() const;

 private:
  glm::vec4 least_{std::numeric_limits<float>::infinity()};
  glm::vec4 greatest_{-std::numeric_limits<float>::infinity()};
};

}  // namespace gnomon::raster
