// Reduced meshes that cast while the originals are drawn: prints rows of docs/kuehl.md for each
// file, in Markdown.
// Usage: measure_casters MESH...
//
// As measure_meshes does, a mesh is scaled to a bounding box of diagonal 1 m and set above a plate,
// three times. What casts is the mesh itself, or what simplify_mesh leaves within so many pixels
// (as mesh simplify --error 0.5px --distance 1.29 --height 480 does), moved from the light by 0, 1,
// 2 and 4 times its measured error (Object::shadow_displace). Every pixel's stencil (automatic
// counting) is compared with rays (Embree) whose caster is the original: on the plate, and on the
// mesh itself where its triangle faces the light and where it is turned from it. Milliseconds (at
// twice the error): making volumes to infinity, and executing depth, volumes and counts (z-fail);
// see mesh_above_plate.h.
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ar/model_file.h"
#include "pipeline/mesh_simplify.h"
#include "pipeline/ray_reference.h"
#include "tests/pipeline/stencil_check.h"
#include "tests/pipeline/test_meshes.h"
#include "tests/tools/mesh_above_plate.h"

namespace gnomon {
namespace {

using namespace pipeline;
using test::kPictures;

constexpr int kWidth = 640, kHeight = 480;
constexpr double kFovDeg = 50.0;

struct Shares {
  std::size_t pixels = 0, wrong = 0;
};

struct Row {
  Shares plate, lit_side, averted_side;
  test::VolumeTimes times;
};

/// Compares with the rays of the scene as it is drawn.
void compare(const Scene& scene, const Camera& camera, Row& row) {
  Scene original = scene;
  for (Object& object : original.objects) object.shadow_model = nullptr;
  const RayReference rays(original);
  const auto samples = rays.cast(pixel_rays(camera), scene.lights[0].position);
  const test::Counted counted = test::count_scene(scene, camera, {}, {.casters_drawn = true});
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto& sample = samples[static_cast<std::size_t>(y * kWidth + x)];
      if (!sample.hit.hit || counted.depth.at(x, y) == counted.depth.max_value()) continue;
      Shares& shares = sample.hit.object == 0     ? row.plate
                       : sample.shadow.faces_away ? row.averted_side
                                                  : row.lit_side;
      ++shares.pixels;
      shares.wrong += sample.shadow.in_shadow != (counted.stencil.at(x, y) != 0);
    }
  }
}

struct Reduction {
  std::shared_ptr<const Model> model;
  /// In the model's own unit, and in metres of the world.
  double error = 0.0, error_m = 0.0;
};

Reduction reduce(const Model& model, double error_px) {
  const double scale = test::scale_to_one_metre(model);
  // Of the nearest point of a mesh of diagonal 1 m about the camera's aim.
  const double distance_m = test::kCameraDistance - 0.5;
  const double bound_m =
      metres_of_pixels(error_px, distance_m, kFovDeg * std::numbers::pi / 180.0, kHeight);
  SimplifiedMesh simple = simplify_mesh(model, bound_m / scale);
  const double error = simple.report.measured_error_m;
  return {std::make_shared<const Model>(std::move(simple.model)), error, error * scale};
}

Row measure(const std::shared_ptr<const Model>& model, const Reduction& caster,
            double times_error) {
  std::mt19937 random(2005);
  Row row;
  for (int picture = 0; picture < kPictures; ++picture) {
    Scene scene = test::mesh_above_plate(model, picture, random);
    const Camera camera = test::camera_about(random, kWidth, kHeight);
    scene.objects[1].shadow_model = caster.model;
    scene.objects[1].shadow_displace = static_cast<float>(times_error * caster.error);
    compare(scene, camera, row);
    test::time_volumes(scene, camera, VolumeGeometry::silhouettes, row.times);
  }
  return row;
}

void print(const std::string& name, const Reduction& caster, std::span<const Row> rows) {
  std::string lit, averted;
  for (const Row& row : rows) {
    lit += (lit.empty() ? "" : ", ") + std::to_string(row.lit_side.wrong);
    averted += (averted.empty() ? "" : ", ") + std::to_string(row.averted_side.wrong);
  }
  const Row& row = rows[rows.size() / 2];
  std::printf("| %s | %zu | %.2f | %zu of %zu | %s of %zu | %s of %zu | %.2f + %.2f |\n",
              name.c_str(), build_topology(*caster.model).triangle_count(), caster.error_m * 1000.0,
              row.plate.wrong, row.plate.pixels, lit.c_str(), row.lit_side.pixels, averted.c_str(),
              row.averted_side.pixels, row.times.make_ms / kPictures,
              row.times.execute_ms / kPictures);
  std::fflush(stdout);
}

void measure_file(const std::filesystem::path& path) {
  const auto model = std::make_shared<const Model>(ar::load_model(path).model);
  const Reduction itself{.model = model};
  print(path.filename(), itself, std::array{measure(model, itself, 0.0)});
  for (const double error_px : {0.5, 2.0}) {
    const Reduction caster = reduce(*model, error_px);
    std::vector<Row> rows;
    for (const double times_error : {0.0, 1.0, 2.0, 4.0})
      rows.push_back(measure(model, caster, times_error));
    print("within " + std::to_string(error_px).substr(0, 3) + " px", caster, rows);
  }
}

int run(int count, char** files) {
  std::puts(
      "| caster | triangles | off, mm | plate: wrong | lit side: wrong, moved by 0, 1, 2, 4 times "
      "that | averted side | ms |\n"
      "| --- | --- | --- | --- | --- | --- | --- |");
  int failed = 0;
  for (int i = 0; i < count; ++i) {
    try {
      measure_file(files[i]);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", files[i], error.what());
      failed = 1;
    }
  }
  return failed;
}

}  // namespace
}  // namespace gnomon

int main(int argc, char** argv) { return gnomon::run(argc - 1, argv + 1); }
