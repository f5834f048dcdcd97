// The scene "tori-N": N tori above a plane under one point light, its light and its camera. It is
// the scene of this project's first comparison with other renderers and stays as it is, so that
// figures can be compared over the years.
#pragma once

#include "pipeline/scene.h"

namespace gnomon::bench {

/// Quads around the ring and around the tube.
struct Tessellation {
  int ring = 48, tube = 24;
};

/// The tori lie on a sunflower's spiral; the plane receives shadows and casts none.
pipeline::Scene tori_scene(int count, Tessellation tessellation = {});

/// The ground without the tori, with the light.
pipeline::Scene ground_scene();

/// Where the torus of that number stands.
glm::mat4 spiral_place(int number);

/// Eye (0, 2.2, 4.2), 50 degrees high, near 0.1, no far plane.
pipeline::Camera tori_camera(int width, int height);

/// From the light, around the tori: near 1, far 12.
pipeline::Camera light_camera(int width, int height);

}  // namespace gnomon::bench
