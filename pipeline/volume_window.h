// Where on the screen an infinite shadow volume can matter: the pixels at which it may hold a
// visible receiver. Counting may be left out elsewhere (after Lloyd et al. 2004, CC shadow volumes,
// who end volumes where receivers end; here in the window, so that no vertex moves).
// Invariant: conservative; a window may be too large. The proof stands in volume_window.cpp.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/placed_object.h"
#include "pipeline/topology.h"
#include "raster/buffers.h"
#include "raster/state.h"

namespace gnomon::pipeline {

/// What a frame's depth is tested with.
struct View {
  glm::mat4 clip_from_world{1.0f};
  int width = 0, height = 0;
  raster::DepthFormat depth_format = raster::DepthFormat::d24;
};

/// The receivers among `objects` that the view may show, by their bounds; those of a few triangles
/// by their triangles.
class ReceiversInView {
 public:
  ReceiversInView(std::span<const PlacedObject> objects, const View& view);

  /// The window of this caster's volume, clamped to the view; empty (no width) where it holds no
  /// receiver in view.
  /// Precondition: the light is a finite point (w = 1) or a direction (w = 0) that is not null.
  raster::Rect window_of(const glm::vec4& light_world, const Topology& caster,
                         const glm::mat4& world_from_model) const;

 private:
  using Corners = std::array<glm::dvec3, 8>;

  struct Receiver {
    glm::dvec3 center{0.0};
    double radius = 0.0;
    /// A bounds' eight corners, bit k of an index the high end along axis k.
    Corners corners{};
    /// Instead of the bounds, where there are few.
    std::vector<std::array<glm::dvec3, 3>> triangles;
    /// Metres by which a volume is widened before it is held to miss the receiver.
    double pad_m = 0.0;
  };

  void add(const PlacedObject& object);
  bool in_view(const Corners& corners) const;
  /// Absent: no distance is enough.
  std::optional<double> pad_of(const Corners& corners) const;

  View view_;
  glm::dmat4 rows_;
  std::vector<Receiver> receivers_;
  /// A receiver that no window can be found for: all windows are the whole view.
  bool unbounded_ = false;
};

}  // namespace gnomon::pipeline
