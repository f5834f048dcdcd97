// Shadow volumes of meshes as they are found, against rays: prints a row of docs/kuehl.md for each
// file, in Markdown.
// Usage: measure_meshes MESH...
//
// A mesh is scaled to a bounding box of diagonal 1 m and set above a plate, three times, turned
// differently; the light is above, a point or a direction. Each picture is counted with robust
// volumes (z-fail, and the automatic choice) and with classical ones (z-fail), and every pixel is
// compared with Embree's answer; so is the picture lit through a shadow map as it is found and
// through an alias-free one (tests/pipeline/light_check.h). Volumes of degenerate quads are
// compared with those of silhouettes: the stencil's bytes after z-pass and z-fail, drawn two-sided
// and in two single-sided passes, to infinity; and the milliseconds of making (least of five, after
// a first one, on one thread) and of executing depth, volumes and counts (z-fail, the same). A
// wrong pixel is explained where a silhouette or a shadow's edge passes within a pixel, or where
// two units of depth decide (tests/pipeline/stencil_check.h).
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "ar/model_file.h"
#include "tests/pipeline/light_check.h"
#include "tests/pipeline/stencil_check.h"
#include "tests/tools/mesh_above_plate.h"

namespace gnomon {
namespace {

using namespace pipeline;

using test::kPictures;

constexpr int kWidth = 320, kHeight = 240;

struct Row {
  test::Disagreement robust_zfail, robust_automatic, classical;
  test::LightCheck map, alias_free;
  std::size_t bytes = 0, different = 0;
  test::VolumeTimes silhouettes, quads;
};

constexpr Extrusion kInfinite{.kind = Extrusion::Kind::infinite};

void compare_geometries(const Scene& scene, const Camera& camera, Row& row) {
  for (const VolumeMethod method : {VolumeMethod::zpass, VolumeMethod::zfail}) {
    VolumeOptions options{.method = method, .extrusion = kInfinite};
    const auto expected = test::count_scene(scene, camera, options).stencil.to_rows();
    options.geometry = VolumeGeometry::degenerate_quads;
    for (const bool single_sided : {false, true}) {
      const auto got = test::count_scene(scene, camera, options, {.single_sided = single_sided})
                           .stencil.to_rows();
      row.bytes += got.size();
      for (std::size_t i = 0; i < got.size(); ++i) row.different += got[i] != expected[i];
    }
  }
}

Row measure(const std::shared_ptr<const Model>& model) {
  std::mt19937 random(2005);
  Row row;
  for (int picture = 0; picture < kPictures; ++picture) {
    const Scene scene = test::mesh_above_plate(model, picture, random);
    const Camera camera = test::camera_about(random, kWidth, kHeight);
    const RayReference rays(scene);
    const auto compare = [&](const VolumeOptions& options) {
      return test::compare_with_rays(test::count_scene(scene, camera, options), scene, rays,
                                     camera);
    };
    row.robust_zfail += compare({.method = VolumeMethod::zfail, .extrusion = kInfinite});
    row.robust_automatic += compare({});
    row.classical += compare({.method = VolumeMethod::zfail,
                              .extrusion = kInfinite,
                              .all_caps = true,
                              .classical = true});
    test::LightMemory memory;
    row.map += test::check_light(memory, scene, camera, ShadowMethod::map);
    row.alias_free += test::check_light(memory, scene, camera, ShadowMethod::alias_free);
    compare_geometries(scene, camera, row);
    test::time_volumes(scene, camera, VolumeGeometry::silhouettes, row.silhouettes);
    test::time_volumes(scene, camera, VolumeGeometry::degenerate_quads, row.quads);
  }
  return row;
}

void print(const std::string& name, const Model& model, const Row& row) {
  const Topology topology = build_topology(model);
  const TopologyFaults& faults = topology.faults;
  const auto pair = [](const test::Disagreement& d) {
    return std::to_string(d.wrong) + ", " + std::to_string(d.unexplained);
  };
  const auto times = [](const test::VolumeTimes& t) {
    char text[64];
    std::snprintf(text, sizeof text, "%.2f + %.2f", t.make_ms / kPictures,
                  t.execute_ms / kPictures);
    return std::string(text);
  };
  const auto check = [](const test::LightCheck& c) {
    return std::to_string(c.dark + c.light) + ", " + std::to_string(c.unexplained);
  };
  std::printf(
      "| %s | %zu | %zu, %zu, %zu | %zu | %s | %s | %s | %s | %s | %zu of %zu | %s | %s |\n",
      name.c_str(), topology.triangle_count(), faults.boundary_edges, faults.non_manifold_edges,
      faults.inconsistent_edges, row.robust_zfail.tested, pair(row.robust_zfail).c_str(),
      pair(row.robust_automatic).c_str(), pair(row.classical).c_str(), check(row.map).c_str(),
      check(row.alias_free).c_str(), row.different, row.bytes, times(row.silhouettes).c_str(),
      times(row.quads).c_str());
  std::fflush(stdout);
}

int run(int count, char** files) {
  std::puts(
      "| mesh | triangles | open, non-manifold, inconsistent edges | pixels | robust z-fail: "
      "wrong, "
      "unexplained | robust automatic | classical z-fail | map | alias-free | degenerate quads: "
      "stencil bytes that "
      "differ | silhouettes, ms | degenerate quads, ms |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
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
