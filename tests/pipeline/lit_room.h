// A room whose light is known: six walls, a panel under the ceiling, perhaps a table, and radiance
// that is the radiosity solution of its own patches.
#pragma once

#include <cstddef>

#include "pipeline/lit_scene.h"
#include "pipeline/scene.h"

namespace gnomon::test {

struct RoomOptions {
  std::size_t patches = 300;
  bool table = true;
  /// Half the panel's side in metres, and its radiance.
  float panel_half_m = 0.4f, panel_radiance = 12.0f;
  /// Of all surfaces but the panel.
  float reflectance = 0.5f;
  /// Bounces of light; 0: only the panel has radiance.
  int bounces = 4;
  /// Of a surface that faces the sun, which stands at (0.3, 1, 0.2) and shines through ceiling and
  /// panel; 0: there is none.
  float sun_irradiance = 0.0f;
};

/// 4 x 4 x 3 metres, the floor at y = 0, the panel's middle at (0.4, 2.9, -0.2), the table's top (a
/// square of 0.8) at y = 0.7 about (-1, ., -1). All surfaces face the room.
pipeline::Scene room_surfaces(const RoomOptions& options = {});

/// tone: gamma 2.2, white at 3.
pipeline::LitScene lit_room(const RoomOptions& options = {});

}  // namespace gnomon::test
