// Golden scenes where they are recorded. Oracles: the frame files, and the hashes of
// golden/manifest.json, which the slow exact renderer of tests/reference made. That the files have
// these hashes in every variant is golden_frames_test's to say.
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ar/buffer_picture.h"
#include "ar/image_file.h"
#include "golden/bless.h"
#include "golden/differences.h"
#include "golden/manifest.h"
#include "golden/scenes.h"
#include "reference/reference.h"

namespace gnomon::golden {

void PrintTo(const Scene& scene, std::ostream* out) { *out << scene.name; }

namespace {

const std::filesystem::path kFolder = GNOMON_SOURCE_DIR "/golden";

const Entry& expected_of(const Scene& scene) {
  static const Manifest kManifest = read_manifest(kFolder);
  return kManifest.at(scene.name);
}

raster::RecordedFrame run_reference(const Scene& scene) {
  raster::RecordedFrame frame = raster::decode_frame(read_frame_bytes(kFolder, scene.frame_name()));
  reference::execute(frame.frame, expected_of(scene).commands);
  return frame;
}

/// Pictures of what was got and of the pixels that differ (white), beside the build.
std::filesystem::path write_pictures(const Scene& scene, const raster::RecordedFrame& got,
                                     const raster::RecordedFrame& expected) {
  const std::filesystem::path folder =
      std::filesystem::path(GNOMON_BUILD_DIR) / "golden" / scene.name;
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < got.buffers.size(); ++i) {
    const BufferHash what = hash_of(got.buffers[i]);
    const std::string name = std::to_string(i) + "_" + what.kind;
    ar::Image white{what.width, what.height, 1, {}};
    white.pixels.resize(static_cast<std::size_t>(what.width) * what.height);
    difference(got.buffers[i], expected.buffers[i],
               [&](int x, int y) { *white.at(x, what.height - 1 - y) = 255; });
    ar::write_png(folder / (name + "_difference.png"), white);
    ar::write_png(folder / (name + "_got.png"), ar::buffer_picture(got.buffers[i]));
  }
  return folder;
}

std::string explain(const Scene& scene, const raster::RecordedFrame& got) {
  const raster::RecordedFrame reference = run_reference(scene);
  return "Against the reference renderer:\n" + sentences(got, reference) +
         "Pictures: " + write_pictures(scene, got, reference).string() +
         (hashes_of(reference) != expected_of(scene).buffers
              ? "\nThe reference's bytes are not the manifest's either: the rules that both follow "
                "have changed."
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

class GoldenScene : public ::testing::TestWithParam<Scene> {};

TEST_P(GoldenScene, RecordedAnewIsItsFrameFile) {
  const Scene& scene = GetParam();
  const raster::RecordedFrame recorded = scene.record();
  EXPECT_EQ(scene.commands(recorded.frame), expected_of(scene).commands);
  EXPECT_EQ(scene.frame_name(), expected_of(scene).frame);
  // Not compared as lists: a message with two megabytes in it helps nobody.
  EXPECT_TRUE(raster::encode_frame(recorded.frame) == read_frame_bytes(kFolder, scene.frame_name()))
      << scene.name << " is recorded otherwise than golden/frames keeps it. If that is meant: "
      << "golden/README.md, Bless.";
}

TEST_P(GoldenScene, HasTheManifestsBytes) {
  const Scene& scene = GetParam();
  const raster::RecordedFrame got =
      replay(read_frame_bytes(kFolder, scene.frame_name()), expected_of(scene).commands, {});
  EXPECT_EQ(hashes_of(got), expected_of(scene).buffers) << scene.name << '\n'
                                                        << explain(scene, got);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenScene, ::testing::ValuesIn(scenes()), test_name);

class GoldenReference : public ::testing::TestWithParam<Scene> {};

TEST_P(GoldenReference, HasTheManifestsBytes) {
  EXPECT_EQ(hashes_of(run_reference(GetParam())), expected_of(GetParam()).buffers);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenReference, ::testing::ValuesIn(quick_scenes()), test_name);

TEST(GoldenManifest, NamesEverySceneAndNoOther) {  // oracle: the list of scenes
  std::vector<std::string> listed, kept;
  for (const Scene& scene : scenes()) listed.push_back(scene.name);
  for (const auto& [name, entry] : read_manifest(kFolder)) kept.push_back(name);
  EXPECT_THAT(kept, ::testing::UnorderedElementsAreArray(listed));
}

}  // namespace gnomon::golden

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--bless") return gnomon::golden::bless();
  ::testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
