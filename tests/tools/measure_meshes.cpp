// Shadow volumes of meshes as they are found, against rays: prints a row of docs/kuehl.md for each
// file, in Markdown.
// Usage: measure_meshes MESH...
//
// A mesh is scaled to a bounding box of diagonal 1 m and set above a plate, three times, turned
// differently; the light is above, a point or a direction. Each picture is counted with robust
// volumes (z-fail, and the automatic choice) and with classical ones (z-fail), and every pixel is
// compared with Embree's answer. A wrong pixel is explained where a silhouette or a shadow's edge
// passes within a pixel, or where two units of depth decide (tests/pipeline/stencil_check.h).
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ar/model_file.h"
#include "tests/pipeline/stencil_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon {
namespace {

using namespace pipeline;

constexpr int kPictures = 3, kWidth = 320, kHeight = 240;

struct Bounds {
  glm::vec3 low{1e30f}, high{-1e30f};
};

Bounds bounds_of(const Model& model, const glm::mat4& world_from_model) {
  Bounds bounds;
  for (const Part& part : model.parts) {
    for (const std::uint32_t index : part.mesh.indices) {
      const glm::vec3 p(world_from_model * part.mesh.positions[index]);
      bounds.low = glm::min(bounds.low, p);
      bounds.high = glm::max(bounds.high, p);
    }
  }
  return bounds;
}

/// The mesh above a plate that casts no shadow of its own.
Scene scene_of(const std::shared_ptr<const Model>& model, int picture, std::mt19937& random) {
  const Bounds own = bounds_of(*model, glm::mat4(1.0f));
  const float scale = 1.0f / glm::length(own.high - own.low);
  glm::mat4 world_from_model =
      test::placed(glm::vec3(0.0f), glm::normalize(test::uniform_point(random, -1.0f, 1.0f)),
                   test::uniform(random, 0.0f, 6.0f), glm::vec3(scale));
  const Bounds turned = bounds_of(*model, world_from_model);
  const glm::vec3 middle = (turned.low + turned.high) * 0.5f;
  world_from_model = test::placed({-middle.x, 0.1f - turned.low.y, -middle.z}) * world_from_model;

  Scene scene;
  scene.objects.push_back(
      {.name = "plate", .model = test::model_of(test::square_mesh(3.0f)), .casts = false});
  scene.objects.push_back({.name = "mesh", .model = model, .world_from_model = world_from_model});
  glm::vec3 at = test::uniform_point(random, -1.0f, 1.0f);
  at.y = test::uniform(random, 1.5f, 2.5f);
  scene.lights.push_back({.name = "lamp", .position = glm::vec4(at, 1.0f)});
  if (picture % 2 == 1) scene.lights[0].position = glm::vec4(glm::normalize(at), 0.0f);
  return scene;
}

struct Row {
  test::Disagreement robust_zfail, robust_automatic, classical;
};

Row measure(const std::shared_ptr<const Model>& model) {
  std::mt19937 random(2005);
  Row row;
  for (int picture = 0; picture < kPictures; ++picture) {
    const Scene scene = scene_of(model, picture, random);
    glm::vec3 eye = test::uniform_point(random, -1.0f, 1.0f);
    eye = glm::normalize(glm::vec3(eye.x, 0.0f, eye.z)) * 1.6f + glm::vec3(0.0f, 1.1f, 0.0f);
    const Camera camera = test::look(eye, {0.0f, 0.3f, 0.0f}, kWidth, kHeight);
    const RayReference rays(scene);
    const auto compare = [&](const VolumeOptions& options) {
      return test::compare_with_rays(test::count_scene(scene, camera, options), scene, rays,
                                     camera);
    };
    const Extrusion infinite{.kind = Extrusion::Kind::infinite};
    row.robust_zfail += compare({.method = VolumeMethod::zfail, .extrusion = infinite});
    row.robust_automatic += compare({});
    row.classical += compare({.method = VolumeMethod::zfail,
                              .extrusion = infinite,
                              .all_caps = true,
                              .classical = true});
  }
  return row;
}

void print(const std::string& name, const Model& model, const Row& row) {
  const Topology topology = build_topology(model);
  const TopologyFaults& faults = topology.faults;
  const auto pair = [](const test::Disagreement& d) {
    return std::to_string(d.wrong) + ", " + std::to_string(d.unexplained);
  };
  std::printf("| %s | %zu | %zu, %zu, %zu | %zu | %s | %s | %s |\n", name.c_str(),
              topology.triangle_count(), faults.boundary_edges, faults.non_manifold_edges,
              faults.inconsistent_edges, row.robust_zfail.tested, pair(row.robust_zfail).c_str(),
              pair(row.robust_automatic).c_str(), pair(row.classical).c_str());
  std::fflush(stdout);
}

int run(int count, char** files) {
  std::puts(
      "| mesh | triangles | open, non-manifold, inconsistent edges | pixels | robust z-fail: "
      "wrong, "
      "unexplained | robust automatic | classical z-fail |\n"
      "| --- | --- | --- | --- | --- | --- | --- |");
  int failed = 0;
  for (int i = 0; i < count; ++i) {
    const std::filesystem::path path = files[i];
    try {
      const auto model = std::make_shared<const Model>(ar::load_model(path).model);
      print(path.filename(), *model, measure(model));
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", path.c_str(), error.what());
      failed = 1;
    }
  }
  return failed;
}

}  // namespace
}  // namespace gnomon

int main(int argc, char** argv) { return gnomon::run(argc - 1, argv + 1); }
