// Golden frames in every variant that this machine has: instruction sets times threads. Needs
// raster/ alone, so that it runs wherever raster/ does. Oracle: the hashes in manifest.json, which
// the slow exact renderer of tests/reference made.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "golden/differences.h"
#include "golden/manifest.h"
#include "golden/variants.h"
#include "reference/reference.h"

namespace gnomon::golden {
namespace {

namespace fs = std::filesystem;

/// Another folder for a test that was built elsewhere.
fs::path folder() {
  const char* named = std::getenv("GNOMON_GOLDEN_DIR");
  return named ? named : GNOMON_SOURCE_DIR "/golden";
}

/// No name where the manifest cannot be read: GoldenFolder says so.
std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  try {
    for (const auto& [name, entry] : read_manifest(folder())) names.push_back(name);
  } catch (const FolderError&) {
  }
  return names;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
}

std::string explain(const std::vector<std::uint8_t>& bytes, std::size_t commands,
                    const raster::RecordedFrame& got) {
  raster::RecordedFrame reference = raster::decode_frame(bytes);
  reference::execute(reference.frame, commands);
  return "Against the reference renderer:\n" + sentences(got, reference);
}

}  // namespace

class GoldenFrame : public ::testing::TestWithParam<std::string> {
 protected:
  static void TearDownTestSuite() {
    std::cout << "golden frames: " << scenes << " scenes, " << variants::every_variant().size()
              << " variants, " << runs << " runs, " << differing << " differing\n";
  }
  static inline std::size_t scenes = 0, runs = 0, differing = 0;
};

TEST_P(GoldenFrame, HasTheManifestsBytesInEveryVariant) {
  const Entry expected = read_manifest(folder()).at(GetParam());
  const std::vector<std::uint8_t> bytes = read_frame_bytes(folder(), expected.frame);
  ++scenes;
  for (const raster::ExecuteOptions& variant : variants::every_variant()) {
    const raster::RecordedFrame got = replay(bytes, expected.commands, variant);
    ++runs;
    if (hashes_of(got) == expected.buffers) continue;
    ++differing;
    const bool first = !HasFailure();
    ADD_FAILURE() << GetParam() << ": " << variants::name(variant)
                  << (first ? '\n' + explain(bytes, expected.commands, got) : "");
  }
}

INSTANTIATE_TEST_SUITE_P(Frames, GoldenFrame, ::testing::ValuesIn(scene_names()), test_name);

TEST(GoldenFolder, HasTheFrameFilesOfItsManifestAndNoOther) {  // oracle: the folder's listing
  std::set<std::string> files, expected;
  for (const auto& entry : fs::directory_iterator(folder() / "frames"))
    files.insert(entry.path().filename().string());
  for (const auto& [name, entry] : read_manifest(folder())) expected.insert(entry.frame + ".frame");
  EXPECT_EQ(files, expected);
}

TEST(GoldenFolder, FilesAreWhatTheFormatsWriterWrites) {  // oracle: encode(decode(file)) == file
  for (const auto& [name, entry] : read_manifest(folder())) {
    const std::vector<std::uint8_t> bytes = read_frame_bytes(folder(), entry.frame);
    EXPECT_TRUE(raster::encode_frame(raster::decode_frame(bytes).frame) == bytes) << name;
  }
}

TEST(GoldenManifest, ComesBackAsItWasWritten) {
  std::ifstream file(manifest_path(folder()));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(manifest_text(read_manifest(folder())), text);
}

TEST(GoldenManifest, ABrokenOneIsRefusedInOneLineThatNamesIt) {
  const fs::path broken = fs::temp_directory_path() / "gnomon-golden-manifest-test";
  fs::create_directories(broken);
  const std::string head = R"({"format": "gnomon-golden 2", "hash": "FNV-1a 64", "scenes": )";
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[]"), std::string("{\"format\": 1}"),
        std::string(R"({"format": "gnomon-golden 1", "hash": "FNV-1a 64", "scenes": {}})"),
        head + "{}}", head + R"({"a": {"frame": "../a", "buffers": []}}})",
        head + R"({"a": {"frame": "", "buffers": []}}})",
        head + R"({"a": {"frame": "a", "buffers": [3]}}})",
        head + R"({"a": {"frame": "a", "buffers": [{"kind": "color"}]}}})",
        head + R"({"a": {"frame": "a"}}})", head + R"({"a": {"buffers": []}}})"}) {
    std::ofstream(manifest_path(broken)) << text;
    try {
      read_manifest(broken);
      ADD_FAILURE() << text;
    } catch (const FolderError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("manifest.json: "));
    }
  }
  fs::remove_all(broken);
  EXPECT_THROW(read_manifest(broken), FolderError);
}

TEST(GoldenHash, IsFnv1a) {  // oracle: the authors' test vectors
  const auto hash = [](std::string_view text) {
    return hash_of(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  EXPECT_EQ(hash(""), "cbf29ce484222325");
  EXPECT_EQ(hash("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(hash("foobar"), "85944171f73967e8");
}

TEST(GoldenDifferences, CountPixelsAndTheLargestDifference) {  // oracle: closed form
  raster::Buffer color = raster::ColorBuffer(70, 3), color_b = color;
  std::get<raster::ColorBuffer>(color_b).rgba8().at(69, 2) = {0, 9, 4, 0};
  std::get<raster::ColorBuffer>(color_b).rgba8().at(0, 0) = {0, 0, 0, 5};
  std::vector<std::pair<int, int>> where;
  const Difference d = difference(color, color_b, [&](int x, int y) { where.emplace_back(x, y); });
  EXPECT_EQ(d.pixels, 2u);
  EXPECT_EQ(d.largest, 9.0);
  EXPECT_THAT(where, ::testing::ElementsAre(std::pair(0, 0), std::pair(69, 2)));
  raster::Buffer depth = raster::DepthBuffer(70, 3), depth_b = depth;
  std::get<raster::DepthBuffer>(depth_b).plane().at(65, 1) -= 70000;
  EXPECT_EQ(difference(depth, depth_b).pixels, 1u);
  EXPECT_EQ(difference(depth, depth_b).largest, 70000.0);
  raster::Buffer stencil = raster::StencilBuffer(70, 3), stencil_b = stencil;
  std::get<raster::StencilBuffer>(stencil_b).plane().at(1, 1) = 255;
  EXPECT_EQ(difference(stencil, stencil_b).largest, 255.0);
  EXPECT_NE(hash_of(stencil).hash, hash_of(stencil_b).hash);
}

}  // namespace gnomon::golden
