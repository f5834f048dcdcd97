// The pictures of one mesh that the figures of docs/kuehl.md are taken from.
#pragma once

#include <memory>
#include <random>

#include "pipeline/make_volumes.h"
#include "pipeline/scene.h"

namespace gnomon::test {

inline constexpr int kPictures = 3;
/// Metres from the camera to the point that it looks at, near the mesh's middle.
inline constexpr double kCameraDistance = 1.79;

/// What makes the bounding box's diagonal 1 m.
float scale_to_one_metre(const pipeline::Model& model);

/// The mesh, so scaled and turned at random, above a plate that casts no shadow of its own; a point
/// light, or a direction in every second picture.
pipeline::Scene mesh_above_plate(const std::shared_ptr<const pipeline::Model>& model, int picture,
                                 std::mt19937& random);
/// Somewhere around it, looking down a little. To be asked after the scene.
pipeline::Camera camera_about(std::mt19937& random, int width, int height);

/// Milliseconds of all pictures.
struct VolumeTimes {
  double make_ms = 0.0, execute_ms = 0.0;
};

/// Adds the least of five times, after a first one, on one thread: making volumes to infinity, and
/// executing depth, volumes and counts (z-fail).
void time_volumes(const pipeline::Scene& scene, const pipeline::Camera& camera,
                  pipeline::VolumeGeometry geometry, VolumeTimes& times);

}  // namespace gnomon::test
