// What is left out of volumes, against the plain method that leaves out nothing.
#include "pipeline/make_volumes.h"

#include <array>
#include <cstdio>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/general_method.h"
#include "pipeline/haller.h"
#include "pipeline/passes.h"
#include "raster/execute.h"
#include "tests/pipeline/stencil_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

constexpr int kWidth = 160, kHeight = 120;

Extrusion extrusion_of(int scene) {
  switch (scene % 3) {
    case 0:
      return {.kind = Extrusion::Kind::infinite};
    case 1:
      return {.kind = Extrusion::Kind::automatic};
    default:
      return {.kind = Extrusion::Kind::radius, .radius_m = 3.0f};
  }
}

/// Every other scene has open sheets and boxes without a side among its bodies.
Scene random_scene(int number, std::mt19937& random) {
  Scene scene = test::random_scene(random);
  if (number % 2 == 0) return scene;
  Mesh open_box = test::box_mesh({0.5f, 0.5f, 0.5f});
  open_box.indices.resize(30);
  scene.objects[1].model = test::model_of(test::square_mesh(0.6f));
  scene.objects.back().model = test::model_of(open_box);
  return scene;
}

/// Anywhere, in shadows and in bodies too; every fourth with the far plane at infinity, every
/// fourth with one that cuts the scene.
Camera random_camera(int number, std::mt19937& random) {
  glm::vec3 eye = test::uniform_point(random, -4.0f, 4.0f);
  eye.y = test::uniform(random, 0.1f, 4.0f);
  const float far = number % 4 == 1 ? 5.0f : 60.0f;
  Camera camera =
      test::look(eye, test::uniform_point(random, -1.0f, 1.0f), kWidth, kHeight, 60.0f, 0.05f, far);
  if (number % 4 == 0) {
    for (int column = 0; column < 4; ++column) {
      camera.clip_from_world[column][2] = camera.clip_from_world[column][3];
    }
    camera.clip_from_world[3][2] -= 2.0f * 0.05f;
  }
  return camera;
}

std::size_t indices_of(const Scene& scene, const Camera& camera, const VolumeOptions& options) {
  TopologyCache topologies;
  const std::vector<PlacedObject> objects = place_objects(scene, camera, topologies);
  std::size_t sum = 0;
  for (const PlacedVolume& volume :
       make_volumes(objects, scene.lights[0], Receivers(scene), {}, options)) {
    sum += volume.volume->indices.size();
  }
  return sum;
}

// Oracle: the same volumes with both caps.
TEST(Caps, LeftOutOfZPassChangeNoByteOfTheStencil) {
  std::mt19937 random(20050);
  std::size_t counted = 0, with_caps = 0, without = 0;
  for (int i = 0; i < 240; ++i) {
    const Scene scene = random_scene(i, random);
    const Camera camera = random_camera(i, random);
    VolumeOptions options{.method = VolumeMethod::zpass, .extrusion = extrusion_of(i)};
    const test::Counted sides = test::count_scene(scene, camera, options);
    without += indices_of(scene, camera, options);
    options.all_caps = true;
    const test::Counted plain = test::count_scene(scene, camera, options);
    with_caps += indices_of(scene, camera, options);
    ASSERT_EQ(sides.stencil.to_rows(), plain.stencil.to_rows()) << "scene " << i;
    for (const std::uint8_t value : plain.stencil.to_rows()) counted += value != 0;
  }
  std::printf("z-pass: %zu pixels with a count, %zu triangles with caps, %zu without\n", counted,
              with_caps / 3, without / 3);
  EXPECT_GT(counted, 100000u);
  EXPECT_LT(without, with_caps * 2 / 3);
}

template <class Options>
Options plain_of(Options options) {
  options.extrusion = {.kind = Extrusion::Kind::infinite};
  options.all_caps = true;
  options.counts = Counts::everywhere;
  return options;
}

View view_of(const Camera& camera) { return {camera.clip_from_world, camera.width, camera.height}; }

struct Buffers {
  raster::ColorBuffer color{kWidth, kHeight}, masks{kWidth, kHeight};
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil{kWidth, kHeight};
  std::vector<std::uint8_t> photograph = std::vector<std::uint8_t>(3 * kWidth * kHeight, 200);

  explicit Buffers(raster::DepthFormat format = raster::DepthFormat::d24)
      : depth(kWidth, kHeight, format) {}
  raster::Targets targets() { return {&color, &depth, &stencil}; }
  raster::Frame record(const Scene& scene, const Camera& camera, HallerOptions options) {
    options.masks = &masks;
    const auto view = raster::ImageView::from_top_row(photograph.data(), kWidth, kHeight, 3);
    return record_haller(scene, camera, view, targets(), options);
  }
  void haller(const Scene& scene, const Camera& camera, const HallerOptions& options) {
    raster::execute(record(scene, camera, options));
  }
  /// Haller's method as far as the last pass of that name; its stencil.
  std::vector<std::uint8_t> haller_counts(const Scene& scene, const Camera& camera,
                                          const HallerOptions& options, const char* label) {
    const raster::Frame frame = record(scene, camera, options);
    raster::execute(frame, {.commands = commands_through(frame, label).value()});
    return stencil.to_rows();
  }
  void general(const Scene& scene, const Camera& camera, const GeneralOptions& options) {
    raster::execute(record_general(scene, camera, targets(), options));
  }
  bool same_picture(const Buffers& other) const {
    return color.to_rgba8_rows() == other.color.to_rgba8_rows() &&
           masks.to_rgba8_rows() == other.masks.to_rgba8_rows() &&
           depth.to_rows() == other.depth.to_rows();
  }
};

// Oracle: the same methods with both caps. Haller's second step counts volumes of casters that are
// not drawn yet: for its stencil their front caps must have stayed.
TEST(Caps, LeftOutOfTheMethodsChangeNoByteOfAnyBuffer) {
  std::mt19937 random(20051);
  for (int i = 0; i < 60; ++i) {
    Scene scene = random_scene(i, random);
    if (i % 3 == 0) {
      scene.lights.push_back({.name = "second", .position = {-1.0f, 5.0f, 2.0f, 1.0f}});
    }
    const Camera camera = random_camera(i, random);
    const auto method = i % 2 ? VolumeMethod::zpass : VolumeMethod::automatic;
    Buffers lean, plain;
    HallerOptions haller{.method = method, .extrusion = extrusion_of(i / 2)};
    haller.double_shadows = i % 5 == 0;
    HallerOptions both_caps = haller;
    both_caps.all_caps = true;
    for (const char* label : {haller_label::kVirtualVolumes, haller_label::kAllVolumes}) {
      ASSERT_EQ(lean.haller_counts(scene, camera, haller, label),
                plain.haller_counts(scene, camera, both_caps, label))
          << label << ", scene " << i;
    }
    lean.haller(scene, camera, haller);
    plain.haller(scene, camera, both_caps);
    ASSERT_TRUE(lean.same_picture(plain)) << "Haller, scene " << i;
    ASSERT_EQ(lean.stencil.to_rows(), plain.stencil.to_rows()) << "Haller, scene " << i;
    GeneralOptions general{.method = method, .extrusion = extrusion_of(i / 2)};
    lean.general(scene, camera, general);
    general.all_caps = true;
    plain.general(scene, camera, general);
    ASSERT_TRUE(lean.same_picture(plain)) << "general method, scene " << i;
    ASSERT_EQ(lean.stencil.to_rows(), plain.stencil.to_rows()) << "general method, scene " << i;
  }
}

/// Objects that do not receive or do not cast, several lights, D16, bodies far away and out of
/// view.
Scene varied_scene(int number, std::mt19937& random) {
  Scene scene = random_scene(number, random);
  for (std::size_t i = 1; i < scene.objects.size(); ++i) {
    scene.objects[i].receives = test::below(random, 5) != 0;
    scene.objects[i].casts = test::below(random, 7) != 0;
  }
  if (number % 3 == 0) {
    // The plate's size decides much: without it, volumes have few receivers.
    scene.objects[0].model = test::model_of(test::box_mesh({0.7f, 0.1f, 0.5f}));
  }
  const std::vector<Object> near_by = scene.objects;
  for (int copies = 0; copies < 2; ++copies) {
    const glm::vec3 away = test::uniform_point(random, -9.0f, 9.0f);
    for (Object object : near_by) {
      object.world_from_model[3] += glm::vec4(away, 0.0f);
      scene.objects.push_back(object);
    }
  }
  if (number % 4 == 3) {
    scene.lights.push_back({.name = "second", .position = {0.2f, 0.9f, -0.4f, 0.0f}});
  }
  return scene;
}

// Oracle: the plain method: every caster's volume to infinity with both caps, counted everywhere.
TEST(CountsAtReceivers, GiveThePlainMethodsPictureByteForByte) {
  std::mt19937 random(20053);
  std::size_t shadowed = 0;
  for (int i = 0; i < 300; ++i) {
    const Scene scene = varied_scene(i, random);
    const Camera camera = random_camera(i, random);
    const raster::DepthFormat format =
        i % 5 == 0 ? raster::DepthFormat::d16 : raster::DepthFormat::d24;
    const VolumeMethod method =
        std::array{VolumeMethod::automatic, VolumeMethod::zfail, VolumeMethod::zpass}[i % 7 % 3];
    Buffers lean(format), plain(format);
    GeneralOptions general{.method = method, .counts = Counts::at_receivers};
    lean.general(scene, camera, general);
    plain.general(scene, camera, plain_of(general));
    ASSERT_TRUE(lean.same_picture(plain)) << "general method, scene " << i;
    GeneralOptions unshadowed;
    Scene light_only = scene;
    for (Object& object : light_only.objects) object.casts = false;
    lean.general(light_only, camera, unshadowed);
    const auto lit = lean.color.to_rgba8_rows(), dark = plain.color.to_rgba8_rows();
    for (std::size_t k = 0; k < lit.size(); k += 4) shadowed += lit[k] != dark[k];

    HallerOptions haller{.method = method, .counts = Counts::at_receivers};
    haller.double_shadows = i % 5 == 1;
    lean.haller(scene, camera, haller);
    plain.haller(scene, camera, plain_of(haller));
    ASSERT_TRUE(lean.same_picture(plain)) << "Haller, scene " << i;
  }
  std::printf("counts at receivers: 300 scenes, %zu shadowed pixels, 0 differ\n", shadowed);
  EXPECT_GT(shadowed, 300u * kWidth * kHeight / 50u);
}

// Oracle: the plain method's stencil at every pixel that shows a surface; all of them receive.
TEST(CountsAtReceivers, AreThePlainMethodsWhereASurfaceIs) {
  std::mt19937 random(20054);
  std::size_t surface = 0, elsewhere = 0, volumes = 0, plain_volumes = 0;
  double area = 0.0;
  for (int i = 0; i < 300; ++i) {
    Scene scene = varied_scene(i, random);
    for (Object& object : scene.objects) object.receives = true;
    const Camera camera = random_camera(i, random);
    const VolumeOptions lean_options{.counts = Counts::at_receivers, .view = view_of(camera)};
    const VolumeOptions plain_options{.extrusion = {.kind = Extrusion::Kind::infinite},
                                      .all_caps = true};
    const test::Counted lean = test::count_scene(scene, camera, lean_options);
    const test::Counted plain = test::count_scene(scene, camera, plain_options);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool same = lean.stencil.at(x, y) == plain.stencil.at(x, y);
        if (plain.depth.at(x, y) == plain.depth.max_value()) {
          elsewhere += !same;
          continue;
        }
        ++surface;
        ASSERT_TRUE(same) << "scene " << i << ", pixel " << x << ", " << y;
      }
    }
    TopologyCache topologies;
    const std::vector<PlacedObject> objects = place_objects(scene, camera, topologies);
    const auto made = make_volumes(objects, scene.lights[0], {},
                                   near_region(camera.clip_from_world), lean_options);
    for (const PlacedVolume& volume : made) {
      area += volume.window ? static_cast<double>(volume.window->width) * volume.window->height /
                                  (kWidth * kHeight)
                            : 1.0;
    }
    volumes += made.size();
    plain_volumes += plain.zpass + plain.zfail;
  }
  std::printf(
      "counts at receivers: %zu pixels with a surface, 0 differ; %zu others do; %zu volumes of "
      "%zu, windows of %.3f of the view\n",
      surface, elsewhere, volumes, plain_volumes, area / static_cast<double>(volumes));
  EXPECT_GT(surface, 1000000u);
  EXPECT_LT(volumes, plain_volumes);
  EXPECT_LT(area, 0.8 * static_cast<double>(volumes));
}

// Oracle: volumes made on one thread, in memory of their own.
TEST(MakeVolumes, AreTheSameForEveryNumberOfThreadsAndInMemoryThatWasUsed) {
  std::mt19937 random(20052);
  VolumeMemory memory;
  std::shared_ptr<const ShadowVolume> kept;
  std::vector<glm::vec4> kept_positions;
  for (int i = 0; i < 30; ++i) {
    Scene scene = random_scene(i, random);
    const std::vector<Object> objects = scene.objects;
    for (int copies = 0; copies < 4; ++copies) {
      scene.objects.insert(scene.objects.end(), objects.begin(), objects.end());
    }
    const Camera camera = random_camera(i, random);
    TopologyCache topologies;
    const std::vector<PlacedObject> placed = place_objects(scene, camera, topologies);
    const auto make = [&](int threads, VolumeMemory* with) {
      return make_volumes(placed, scene.lights[0], Receivers(scene),
                          near_region(camera.clip_from_world),
                          {.extrusion = extrusion_of(i), .threads = threads, .memory = with});
    };
    const std::vector<PlacedVolume> expected = make(1, nullptr);
    for (const int threads : {1, 2, 3, 7}) {
      const std::vector<PlacedVolume> got = make(threads, &memory);
      ASSERT_EQ(got.size(), expected.size());
      for (std::size_t k = 0; k < got.size(); ++k) {
        ASSERT_EQ(got[k].caster, expected[k].caster);
        ASSERT_EQ(got[k].method, expected[k].method);
        ASSERT_EQ(got[k].volume->positions, expected[k].volume->positions);
        ASSERT_EQ(got[k].volume->indices, expected[k].volume->indices);
      }
    }
    // What is still held keeps its content, however often the memory was used since.
    if (kept) {
      ASSERT_EQ(kept->positions, kept_positions);
    }
    const std::vector<PlacedVolume> last = make(2, &memory);
    ASSERT_FALSE(last.empty());
    kept = last[0].volume;
    kept_positions = kept->positions;
  }
}

}  // namespace
}  // namespace gnomon::pipeline
