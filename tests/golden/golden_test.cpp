// Golden scenes: the same bytes on every machine and on every number of threads. Oracle: the hashes
// in golden/manifest.json, which the slow exact renderer of tests/reference made.
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "golden/bless.h"
#include "golden/differences.h"
#include "golden/manifest.h"
#include "raster/execute.h"
#include "reference/reference.h"

namespace gnomon::golden {

void PrintTo(const Scene& scene, std::ostream* out) { *out << scene.name; }

namespace {

const Entry& expected_of(const Scene& scene) {
  static const std::map<std::string, Entry> kManifest = read_manifest();
  return kManifest.at(scene.name);
}

Targets run(const Scene& scene, int threads) {
  Targets targets = scene.make_targets();
  const raster::Frame frame = scene.record(targets);
  raster::execute(frame, {.threads = threads, .commands = scene.commands(frame)});
  return targets;
}

Targets run_reference(const Scene& scene) {
  Targets targets = scene.make_targets();
  const raster::Frame frame = scene.record(targets);
  reference::execute(frame, scene.commands(frame));
  return targets;
}

/// Leaves pictures beside the build and says where the bytes part from the reference's.
std::string explain(const Scene& scene, int threads, const Targets& got) {
  const std::filesystem::path folder = std::filesystem::path(GNOMON_BUILD_DIR) / "golden" /
                                       (scene.name + "-threads-" + std::to_string(threads));
  const Targets reference = run_reference(scene);
  write_differences(folder, got, reference);
  const bool recorded_otherwise = entry_of(reference) != expected_of(scene);
  return "Against the reference renderer:\n" + sentence(differences(got, reference)) +
         "\nPictures: " + folder.string() +
         (recorded_otherwise
              ? "\nThe reference's bytes are not the manifest's either: the frame is recorded "
                "otherwise, or the rules that both follow have changed."
              : "");
}

std::string test_name(const ::testing::TestParamInfo<Scene>& info) {
  std::string name = info.param.name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
}

std::vector<Scene> quick_scenes() {
  std::vector<Scene> quick;
  for (const Scene& scene : scenes())
    if (scene.quick) quick.push_back(scene);
  return quick;
}

}  // namespace

class Golden : public ::testing::TestWithParam<Scene> {};

TEST_P(Golden, HasTheManifestsBytesOn1And2And3And7And16Threads) {
  const Scene& scene = GetParam();
  for (const int threads : {1, 2, 3, 7, 16}) {
    const Targets got = run(scene, threads);
    ASSERT_EQ(entry_of(got), expected_of(scene)) << scene.name << " on " << threads << " threads\n"
                                                 << explain(scene, threads, got);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, ::testing::ValuesIn(scenes()), test_name);

class GoldenReference : public ::testing::TestWithParam<Scene> {};

TEST_P(GoldenReference, HasTheManifestsBytes) {
  EXPECT_EQ(entry_of(run_reference(GetParam())), expected_of(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenReference, ::testing::ValuesIn(quick_scenes()), test_name);

TEST(GoldenManifest, NamesEveryScene) {  // oracle: the list of scenes
  std::vector<std::string> listed, kept;
  for (const Scene& scene : scenes()) listed.push_back(scene.name);
  for (const auto& [name, entry] : read_manifest()) kept.push_back(name);
  EXPECT_THAT(kept, ::testing::UnorderedElementsAreArray(listed));
}

TEST(GoldenHash, IsFnv1a) {  // oracle: the authors' test vectors
  const auto hash = [](std::string_view text) {
    return hash_of(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  EXPECT_EQ(hash(""), "cbf29ce484222325");
  EXPECT_EQ(hash("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(hash("foobar"), "85944171f73967e8");
}

TEST(GoldenDifferences, CountsPixelsAndTheLargestDifference) {  // oracle: closed form
  Targets a(70, 3, raster::ColorFormat::rgba8, raster::DepthFormat::d24), b = a;
  b.color.rgba8().at(69, 2) = {0, 9, 4, 0};
  b.color.rgba8().at(0, 0) = {0, 0, 0, 5};
  b.depth.plane().at(65, 1) -= 70000;
  b.stencil.plane().at(1, 1) = 255;
  const Differences d = differences(a, b);
  EXPECT_EQ(d.color_pixels, 2u);
  EXPECT_EQ(d.color, 9.0);
  EXPECT_EQ(d.depth_pixels, 1u);
  EXPECT_EQ(d.depth, 70000.0);
  EXPECT_EQ(d.stencil_pixels, 1u);
  EXPECT_EQ(d.stencil, 255.0);
}

}  // namespace gnomon::golden

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--bless") return gnomon::golden::bless();
  ::testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
