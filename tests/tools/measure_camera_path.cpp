// Why z-fail: a camera that flies through a shadow volume. Prints a line a frame for gnuplot:
// frame, and the wrong pixels of z-pass, z-fail and the automatic choice against Embree, as shares
// of the pixels that show a surface; then whether the eye is in the shadow by a ray. Usage:
// measure_camera_path > path.dat && gnuplot tests/tools/camera_path.gp
#include <cstdio>

#include "tests/pipeline/stencil_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon {
namespace {

using namespace pipeline;

constexpr int kFrames = 120, kWidth = 320, kHeight = 240;

/// A box under a lamp, its shadow on a plate, and two bodies to look at.
Scene make_scene() {
  Scene scene;
  scene.objects.push_back(
      {.name = "plate", .model = test::model_of(test::square_mesh(4.0f)), .casts = false});
  scene.objects.push_back({.name = "box",
                           .model = test::model_of(test::box_mesh({0.6f, 0.1f, 0.6f})),
                           .world_from_model = test::placed({0.0f, 1.6f, 0.0f})});
  scene.objects.push_back({.name = "ball",
                           .model = test::model_of(test::icosphere_mesh(0.3f, 3)),
                           .world_from_model = test::placed({0.3f, 0.3f, -1.2f})});
  scene.objects.push_back(
      {.name = "torus",
       .model = test::model_of(test::torus_mesh(0.35f, 0.12f, 24, 12)),
       .world_from_model = test::placed({-0.8f, 0.4f, -1.8f}, {1.0f, 0.0f, 0.0f}, 0.9f)});
  scene.lights.push_back({.name = "lamp", .position = {0.1f, 4.0f, 0.2f, 1.0f}});
  return scene;
}

void run() {
  const Scene scene = make_scene();
  const RayReference rays(scene);
  std::puts("# frame z-pass z-fail automatic eye-in-shadow");
  for (int frame = 0; frame < kFrames; ++frame) {
    // Through the box's volume, from its left to its right, looking ahead and down.
    const float along = -2.0f + 4.0f * static_cast<float>(frame) / (kFrames - 1);
    const glm::vec3 eye(along, 0.8f, 0.15f);
    const Camera camera =
        test::look(eye, {0.4f * along, 0.3f, -1.5f}, kWidth, kHeight, 60.0f, 0.05f);
    std::printf("%d", frame);
    for (const VolumeMethod method :
         {VolumeMethod::zpass, VolumeMethod::zfail, VolumeMethod::automatic}) {
      const test::Disagreement found = test::compare_with_rays(
          test::count_scene(scene, camera,
                            {.method = method, .extrusion = {.kind = Extrusion::Kind::infinite}}),
          scene, rays, camera);
      std::printf(" %.6f", static_cast<double>(found.wrong) / static_cast<double>(found.tested));
    }
    std::printf(" %d\n", rays.blocked(glm::dvec3(eye), scene.lights[0].position) ? 1 : 0);
  }
}

}  // namespace
}  // namespace gnomon

int main() { gnomon::run(); }
