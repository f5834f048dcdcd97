// Oracle: the figures that the scene was described with when it was first compared with other
// renderers; closed forms.
#include "bench/subject.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "bench/layer.h"
#include "bench/volumes.h"
#include "pipeline/placed_object.h"

namespace gnomon::bench {
namespace {

std::size_t volume_triangles(const Subject& subject, Method method) {
  pipeline::TopologyCache topologies;
  const auto objects = pipeline::place_objects(subject.scene, subject.camera, topologies);
  std::size_t count = 0;
  for (const auto& volume : make_volumes(subject, objects, method, 1, nullptr)) {
    count += volume.volume->indices.size() / 3;
  }
  return count;
}

TEST(ToriScene, HasTheTrianglesAndVolumesOfItsFirstComparison) {
  const Subject subject = make_subject("tori-12", {640, 480});
  std::size_t triangles = 0;
  for (const auto& object : subject.scene.objects) {
    triangles += object.model->parts.at(0).mesh.triangle_count();
  }
  EXPECT_EQ(triangles, 12u * 2304u + 2u);
  EXPECT_EQ(volume_triangles(subject, Method::zfail), 30320u);
  EXPECT_EQ(volume_triangles(subject, Method::zpass), 3056u);
}

TEST(GridScene, HasAboutTheTrianglesThatItsNameSays) {
  for (const int wanted : {1000, 30000, 1000000}) {
    const Subject subject = make_subject("grid-" + std::to_string(wanted), {64, 48});
    const auto& mesh = subject.scene.objects.at(1).model->parts.at(0).mesh;
    const double triangles = 12.0 * static_cast<double>(mesh.triangle_count());
    // The tube's quads are a rounded root; the smallest grid has 5 of them, 4.56 would be exact.
    EXPECT_NEAR(triangles / wanted, 1.0, 0.21) << wanted;
  }
}

TEST(Subject, RefusesNamesThatNoSceneHas) {
  for (const char* name : {"", "tori", "tori-", "tori-0", "tori-99999", "tori-12x", "grid-5",
                           "depth--3", "layer", "tori-99999999999999999999"}) {
    EXPECT_THROW(make_subject(name, {64, 48}), std::invalid_argument) << name;
  }
}

TEST(Size, IsReadAsItIsWritten) {
  EXPECT_EQ(size_from("640x480"), (Size{640, 480}));
  EXPECT_EQ(text(size_from("16384x1")), "16384x1");
}

TEST(Size, RefusesWhatIsNone) {
  for (const char* wrong : {"", "x", "640", "640x", "x480", "0x480", "640x-1", "640x480x2",
                            "640X480", "99999x1", "6 40x480", "640x480 "}) {
    EXPECT_THROW(size_from(wrong), std::invalid_argument) << wrong;
  }
}

TEST(RandomDepths, LieOnBothSidesOfTheLayerInEveryBlock) {
  const auto depths = random_depths(64, 64);
  for (std::size_t block_y = 0; block_y < 8; ++block_y) {
    for (std::size_t block_x = 0; block_x < 8; ++block_x) {
      std::size_t nearer = 0;
      for (std::size_t pixel = 0; pixel < 64; ++pixel) {
        nearer += depths[(block_y * 8 + pixel / 8) * 64 + block_x * 8 + pixel % 8] < 1u << 23;
      }
      EXPECT_GT(nearer, 0u);
      EXPECT_LT(nearer, 64u);
    }
  }
}

}  // namespace
}  // namespace gnomon::bench
