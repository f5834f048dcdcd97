#include "ar/gltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "ar/error.h"
#include "ar/file.h"
#include "tests/ar/model_checks.h"
#include "tests/ar/temporary_folder.h"

namespace gnomon::ar {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kData = fs::path(GNOMON_SOURCE_DIR) / "tests/data/gltf";

std::size_t triangle_count(const pipeline::Model& model) {
  std::size_t count = 0;
  for (const pipeline::Part& part : model.parts) count += part.mesh.triangle_count();
  return count;
}

/// What read_gltf promises of every model.
void expect_sound(const pipeline::Model& model) {
  for (const pipeline::Part& part : model.parts) {
    const pipeline::Mesh& mesh = part.mesh;
    test::expect_sound_mesh(mesh);
    if (::testing::Test::HasFatalFailure()) return;
    EXPECT_TRUE(mesh.texcoords.empty() || mesh.texcoords.size() == mesh.positions.size());
    EXPECT_EQ(part.texture == nullptr, mesh.texcoords.empty());
  }
}

std::size_t distinct_positions(const pipeline::Model& model) {
  std::set<std::array<float, 3>> distinct;
  for (const pipeline::Part& part : model.parts)
    for (const glm::vec4& p : part.mesh.positions) distinct.insert({p.x, p.y, p.z});
  return distinct.size();
}

std::string message_of(const fs::path& path) {
  try {
    read_gltf(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// Oracle: triangle and welded vertex counts taken by another reader (trimesh), each mesh counted
// once.
TEST(Gltf, TrianglesAndWeldedVerticesAreThoseOfAnotherReader) {
  struct Expected {
    const char* file;
    std::size_t triangles, welded;
  };
  for (const Expected& e :
       {Expected{"Box.glb", 12, 8}, Expected{"BoxInterleaved.glb", 12, 8},
        Expected{"box_sparse.glb", 12, 8}, Expected{"BoxTextured.glb", 12, 8},
        Expected{"CornellBox.glb", 36, 28}, Expected{"nested.glb", 36, 0},
        Expected{"no_indices_3storybuilding.glb", 72, 0}, Expected{"alien_kenney.glb", 292, 0},
        Expected{"SimpleSkin.gltf", 8, 10}, Expected{"boxNotManifold.glb", 12, 9}}) {
    const GltfModel file = read_gltf(kData / "good" / e.file);
    EXPECT_EQ(triangle_count(file.model), e.triangles) << e.file;
    if (e.welded != 0) {
      EXPECT_EQ(distinct_positions(file.model), e.welded) << e.file;
    }
    expect_sound(file.model);
  }
}

// Oracle: the files' own meaning: modes 4, 5 and 6 (without, then with indices) draw one square of
// side 1.
TEST(Gltf, ListStripAndFanDrawTheSameSquare) {
  for (const char* mode : {"04", "05", "06", "11", "12", "13"}) {
    const GltfModel file =
        read_gltf(kData / "good" / ("Mesh_PrimitiveMode_" + std::string(mode) + ".gltf"));
    EXPECT_EQ(triangle_count(file.model), 2u) << mode;
    glm::dvec3 area(0.0);
    for (const pipeline::Part& part : file.model.parts)
      for (std::size_t i = 0; i < part.mesh.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) {
          return glm::dvec3(part.mesh.positions[part.mesh.indices[i + k]]);
        };
        area += glm::cross(at(1) - at(0), at(2) - at(0)) / 2.0;
      }
    // Both triangles face the same way, or their areas would cancel.
    EXPECT_NEAR(std::abs(area.z), 1.0, 1e-6) << mode;
  }
}

// Oracle: each is an InputError of one line that names the file, or a sound model.
TEST(Gltf, FaultyFilesAreRefusedOrSound) {
  for (const auto& entry : fs::recursive_directory_iterator(kData / "bad")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".gltf" && extension != ".glb") continue;
    try {
      expect_sound(read_gltf(entry.path()).model);
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(entry.path().filename().string()));
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    }
  }
}

TEST(Gltf, RefusalsNameThePlaceAndTheValue) {
  const std::map<std::string, std::string> expected{
      {"IndexOutOfRange.gltf",
       "mesh 0 'Mesh' primitive 0: index 255 at place 0 is not below the 24 positions"},
      {"BoxWithInfinites.glb",
       "mesh 0 'Mesh' primitive 0 POSITION: accessor 2: component 0 of element 0 is -inf"},
      {"RecursiveNodes.gltf", "node 0 is reached twice (again from node 1)"},
      {"Cube.gltf", "35 corners are not whole triangles"},
      {"NoScene.gltf", "scene 0 is not one of 0"},
      {"SceneWithoutNodes.gltf", "no triangle in the scene"},
      {"issue-416.gltf", "asset.version is \"\"; glTF 2.0 is read"},
      {"integer-out-of-bounds.gltf", "'byteLength' property is not a positive integer"},
      {"invalid-buffer-index.gltf", "bufferView 1: buffer is not one of 1"},
      {"missing/BoxTextured.gltf", "BoxTextured0.bin"},
      {"Mesh_PrimitiveMode_01.gltf", "mesh 0 primitive 0: points and lines are left out"}};
  for (const auto& [file, message] : expected)
    EXPECT_THAT(message_of(kData / "bad" / file), HasSubstr(message)) << file;
}

// Oracle: every prefix of a .glb lacks bytes that its header counts.
TEST(Gltf, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  const auto bytes = read_file(kData / "good/Box.glb", 1 << 20);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    write_file(folder.path() / "cut.glb", {reinterpret_cast<const char*>(bytes.data()), length});
    EXPECT_THAT(message_of(folder.path() / "cut.glb"), HasSubstr("cut.glb")) << length;
  }
}

// Oracle: no crash, and what is read is sound; run under ASan and UBSan too.
TEST(Gltf, FlippedBytesNeverCrash) {
  const TemporaryFolder folder;
  for (const char* name : {"Box.glb", "box_sparse.glb", "SimpleSkin.gltf"}) {
    const auto bytes = read_file(kData / "good" / name, 1 << 20);
    for (std::size_t at = 0; at < bytes.size(); ++at)
      for (const int change : {0xff, 0x01}) {
        std::string bad(bytes.begin(), bytes.end());
        bad[at] = static_cast<char>(bad[at] ^ change);
        const fs::path path = folder.path() / name;
        write_file(path, bad);
        try {
          expect_sound(read_gltf(path).model);
          read_gltf_nodes(path);
        } catch (const InputError&) {
        }
      }
  }
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static const char* const kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return k < bytes.size() ? bytes[k] : 0u; };
    const std::uint32_t word = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (int d = 3; d >= 0; --d) text += kDigits[word >> (6 * d) & 63];
  }
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  return text.substr(0, text.size() - padding) + std::string(padding, '=');
}

template <class T>
void append(std::vector<std::uint8_t>& bytes, std::initializer_list<T> values) {
  for (const T value : values) {
    std::array<std::uint8_t, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  }
}

/// A tetrahedron with 16-bit indices in one embedded buffer: volume 1/6, faces outwards.
json tetrahedron() {
  std::vector<std::uint8_t> bytes;
  append<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  append<std::uint16_t>(bytes, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
  return {
      {"asset", {{"version", "2.0"}}},
      {"buffers",
       {{{"byteLength", 72}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteLength", 48}},
        {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 24}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", 12}, {"type", "SCALAR"}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"scenes", {{{"nodes", {0}}}}},
      {"scene", 0}};
}

fs::path write_json(const TemporaryFolder& folder, const json& document) {
  const fs::path path = folder.path() / "t.gltf";
  write_file(path, document.dump());
  return path;
}

// Oracle: 6 V = 1 for the tetrahedron; a transform scales it by its determinant, and a mirrored one
// keeps its outside outside.
TEST(Gltf, NodesPlaceMeshesAndMirroredOnesKeepTheirOutside) {
  const TemporaryFolder folder;
  json document = tetrahedron();
  EXPECT_DOUBLE_EQ(test::volume6(read_gltf(write_json(folder, document)).model), 1.0);
  document["nodes"][0]["scale"] = {-2, 3, 1};
  EXPECT_DOUBLE_EQ(test::volume6(read_gltf(write_json(folder, document)).model), 6.0);
  document["nodes"] = {{{"children", {1}}, {"translation", {1, 2, 3}}},
                       {{"mesh", 0}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}};
  const GltfModel turned = read_gltf(write_json(folder, document));
  const auto& positions = turned.model.parts[0].mesh.positions;
  bool found = false;
  for (const glm::vec4& p : positions)
    found = found || glm::distance(p, glm::vec4(1, 3, 3, 1)) < 1e-6f;
  EXPECT_TRUE(found) << "x turned to y by 90 degrees about z, then moved";
}

// Oracle: normals of the slanted face by hand; under a scale of (1, 1, 2) the normal (1, 1, 1)
// becomes (1, 1, 1/2).
TEST(Gltf, AbsentNormalsAreFlatAndFollowTheInverseTranspose) {
  const TemporaryFolder folder;
  json document = tetrahedron();
  document["nodes"][0]["scale"] = {1, 1, 2};
  const GltfModel file = read_gltf(write_json(folder, document));
  const pipeline::Mesh& mesh = file.model.parts[0].mesh;
  EXPECT_EQ(mesh.positions.size(), 12u) << "each corner its own";
  EXPECT_EQ(distinct_positions(file.model), 4u) << "with the bits they had";
  const glm::vec3 expected = glm::normalize(glm::vec3(1.0f, 1.0f, 0.5f));
  for (std::size_t i = 9; i < 12; ++i) EXPECT_LT(glm::distance(mesh.normals[i], expected), 1e-6f);
}

// Oracle: the same rule on normals that the file gives.
TEST(Gltf, GivenNormalsFollowTheInverseTranspose) {
  const TemporaryFolder folder;
  json document = tetrahedron();
  std::vector<std::uint8_t> bytes;
  append<float>(bytes, {1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 5});
  document["buffers"].push_back(
      {{"byteLength", 48}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
  document["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 48}});
  document["accessors"].push_back(
      {{"bufferView", 2}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 2;
  document["nodes"][0]["scale"] = {1, 1, 2};
  const GltfModel file = read_gltf(write_json(folder, document));
  const auto& normals = file.model.parts[0].mesh.normals;
  ASSERT_EQ(normals.size(), 4u);
  EXPECT_LT(glm::distance(normals[0], glm::normalize(glm::vec3(1.0f, 1.0f, 0.5f))), 1e-6f);
  EXPECT_LT(glm::distance(normals[3], glm::vec3(0, 0, 1)), 1e-6f);
}

// Oracle: sRGB's 0.5 linear -> 0.735; defaults and clamps as docs/models.md says.
TEST(Gltf, MaterialsBecomeFixedFunctionOnes) {
  const TemporaryFolder folder;
  json document = tetrahedron();
  EXPECT_EQ(read_gltf(write_json(folder, document)).model.parts[0].material.diffuse,
            glm::vec3(1.0f));
  document["materials"] = {{{"doubleSided", true},
                            {"emissiveFactor", {0.0, 1.0, 0.0}},
                            {"pbrMetallicRoughness",
                             {{"baseColorFactor", {0.5, 0.0, 1.0, 0.3}},
                              {"metallicFactor", 0},
                              {"roughnessFactor", 0.5}}}}};
  document["meshes"][0]["primitives"][0]["material"] = 0;
  const GltfModel file = read_gltf(write_json(folder, document));
  const pipeline::Part& part = file.model.parts[0];
  EXPECT_NEAR(part.material.diffuse.x, 0.7354f, 1e-4f);
  EXPECT_EQ(part.material.diffuse.y, 0.0f);
  EXPECT_NEAR(part.material.diffuse.z, 1.0f, 1e-6f);
  EXPECT_EQ(part.material.ambient, part.material.diffuse);
  EXPECT_NEAR(part.material.emission.y, 1.0f, 1e-6f);
  EXPECT_EQ(part.material.alpha, 1.0f);
  EXPECT_TRUE(part.two_sided);
  EXPECT_EQ(part.material.shininess, 30) << "2 / 0.25^2 - 2";
  EXPECT_NEAR(part.material.specular.x, 0.04f * 38.0f / 8.0f, 1e-6f);
  document["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 1.0;
  EXPECT_EQ(read_gltf(write_json(folder, document)).model.parts[0].material.specular,
            glm::vec3(0.0f));
}

// Oracle: the picture in the file is 256 x 256; glTF's v grows downwards as the rows do.
TEST(Gltf, TexturesKeepTheirRowsAndAreShared) {
  const GltfModel file = read_gltf(kData / "good/BoxTextured.glb");
  const pipeline::Part& part = file.model.parts.at(0);
  ASSERT_NE(part.texture, nullptr);
  EXPECT_EQ(part.texture->texels.size(),
            static_cast<std::size_t>(part.texture->width) * part.texture->height);
  EXPECT_EQ(part.texture->width, 256);
  EXPECT_EQ(part.texture->height, 256);
}

// Oracle: normalised integers by hand: 255 -> 1, and the colour through the sRGB curve.
TEST(Gltf, NormalisedColoursAreRead) {
  const TemporaryFolder folder;
  json document = tetrahedron();
  std::vector<std::uint8_t> bytes;
  append<std::uint8_t>(bytes, {255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 255, 255, 255, 0});
  document["buffers"].push_back(
      {{"byteLength", 16}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
  document["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 16}, {"byteStride", 4}});
  document["accessors"].push_back({{"bufferView", 2},
                                   {"componentType", 5121},
                                   {"normalized", true},
                                   {"count", 4},
                                   {"type", "VEC3"}});
  document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 2;
  const GltfModel file = read_gltf(write_json(folder, document));
  const auto& colors = file.model.parts[0].mesh.colors;
  ASSERT_EQ(colors.size(), 12u);
  EXPECT_LT(glm::distance(colors[1], glm::vec4(0, 0, 1, 1)), 1e-6f) << "corner 1 is vertex 2";
}

struct Hostile {
  const char* name;
  void (*change)(json&);
  const char* message;
};

// Oracle: what each change breaks.
TEST(Gltf, HostileNumbersAreRefusedByPlaceAndValue) {
  const TemporaryFolder folder;
  const Hostile cases[] = {
      {"accessor", [](json& d) { d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 7; },
       "mesh 0 primitive 0 POSITION: accessor 7 is not one of 2"},
      {"negative accessor",
       [](json& d) { d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = -3; },
       "accessor -3 is not one of 2"},
      {"view", [](json& d) { d["accessors"][0]["bufferView"] = 9; },
       "bufferView 9 is not one of 2"},
      {"count", [](json& d) { d["accessors"][0]["count"] = 5; },
       "5 elements from byte 0 reach behind the 48 bytes of bufferView 0"},
      {"huge count", [](json& d) { d["accessors"][0]["count"] = 18446744073709551615ull; },
       "values; 1 to"},
      {"offset", [](json& d) { d["accessors"][0]["byteOffset"] = 18446744073709551600ull; },
       "from byte 18446744073709551600"},
      {"view offset", [](json& d) { d["bufferViews"][0]["byteOffset"] = 40; },
       "bufferView 0: 48 bytes from byte 40 reach behind the 72 of buffer 0"},
      {"stride", [](json& d) { d["bufferViews"][0]["byteStride"] = 8; },
       "byteStride 8 for elements of 12 bytes"},
      {"type", [](json& d) { d["accessors"][0]["type"] = "VEC2"; }, "has 2 components, not 3"},
      {"float indices", [](json& d) { d["meshes"][0]["primitives"][0]["indices"] = 0; },
       "holds no unsigned integers"},
      {"mode", [](json& d) { d["meshes"][0]["primitives"][0]["mode"] = 9; },
       "mode 9 is not one of 0 to 6"},
      {"material", [](json& d) { d["meshes"][0]["primitives"][0]["material"] = 4; },
       "material 4 is not one of 0"},
      {"mesh", [](json& d) { d["nodes"][0]["mesh"] = 3; }, "node 0: mesh 3 is not one of 1"},
      {"child", [](json& d) { d["nodes"][0]["children"] = {5}; }, "node 0: node 5 is not one of 1"},
      {"own child", [](json& d) { d["nodes"][0]["children"] = {0}; }, "node 0 is reached twice"},
      {"scene node", [](json& d) { d["scenes"][0]["nodes"] = {8}; },
       "scene: node 8 is not one of 1"},
      {"overflow",
       [](json& d) {
         d["nodes"][0]["scale"] = {1e39, 1, 1};
       },
       "POSITION[1] is inf when placed"},
      {"zero quaternion",
       [](json& d) {
         d["nodes"][0]["rotation"] = {0, 0, 0, 0};
       },
       "node 0: rotation: a quaternion of length 0"},
      {"projective",
       [](json& d) { d["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
       "node 0: matrix: the last row is not 0 0 0 1"},
      {"extension", [](json& d) { d["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
       "required extension \"KHR_draco_mesh_compression\" is not read"},
      {"buffer", [](json& d) { d["buffers"][0]["byteLength"] = 1ull << 40; },
       "buffer 0: byteLength is not within 1 to"},
      {"version", [](json& d) { d["asset"]["version"] = "1.0"; }, "asset.version is \"1.0\""},
      {"colour",
       [](json& d) {
         d["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {2, 0, 0, 1}}}}}};
         d["meshes"][0]["primitives"][0]["material"] = 0;
       },
       "material 0: baseColorFactor: 2 is not within 0 to 1"}};
  for (const Hostile& hostile : cases) {
    json document = tetrahedron();
    hostile.change(document);
    const std::string message = message_of(write_json(folder, document));
    EXPECT_THAT(message, HasSubstr(hostile.message)) << hostile.name;
    EXPECT_THAT(message, HasSubstr("t.gltf: ")) << hostile.name;
  }
}

// Oracle: a file outside the model's folder exists and is not read.
TEST(Gltf, OnlyTheModelsOwnFolderIsRead) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "model");
  const std::string secret(72, '\1');
  write_file(folder.path() / "secret.bin", secret);
  const auto refused = [&](const std::string& uri, const std::string& expected) {
    json document = tetrahedron();
    document["buffers"][0]["uri"] = uri;
    const fs::path path = folder.path() / "model/t.gltf";
    write_file(path, document.dump());
    EXPECT_THAT(message_of(path), HasSubstr(expected)) << uri;
  };
  refused("../secret.bin", "leaves the model's folder");
  refused("%2e%2e/secret.bin", "leaves the model's folder");
  refused("a/../../secret.bin", "leaves the model's folder");
  refused((folder.path() / "secret.bin").string(), "is no relative path");
  refused("file:///etc/passwd", "is no relative path");
  refused("https://example.org/a.bin", "is no relative path");
  refused("a%zz", "has a % without two hexadecimal digits");
  fs::create_symlink(folder.path() / "secret.bin", folder.path() / "model/link.bin");
  refused("link.bin", "link.bin");
  write_file(folder.path() / "model/own name.bin", secret);
  json document = tetrahedron();
  document["buffers"][0]["uri"] = "own%20name.bin";
  write_file(folder.path() / "model/t.gltf", document.dump());
  EXPECT_THAT(message_of(folder.path() / "model/t.gltf"), HasSubstr("index 257"))
      << "the file in the folder was read";
}

TEST(Gltf, DeepNestingIsRefusedBeforeAnyParserRecurses) {
  const TemporaryFolder folder;
  write_file(folder.path() / "deep.gltf",
             "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(100000, '[') +
                 std::string(100000, ']') + "}");
  EXPECT_THAT(message_of(folder.path() / "deep.gltf"), HasSubstr("JSON nested deeper than 64"));
}

// Oracle: extras as written; the middle of the tetrahedron's box, moved.
TEST(Gltf, NodesHaveNamesExtrasAndAMiddle) {
  const TemporaryFolder folder;
  json document = tetrahedron();
  document["nodes"] = {{{"name", "lamp"}, {"children", {1}}, {"translation", {1, 2, 3}}},
                       {{"name", "bulb"}, {"mesh", 0}, {"extras", {{"role", "emitter"}}}}};
  const std::vector<GltfNode> nodes = read_gltf_nodes(write_json(folder, document));
  ASSERT_EQ(nodes.size(), 2u);
  EXPECT_EQ(nodes[0].name, "lamp");
  EXPECT_EQ(nodes[0].extras, "");
  EXPECT_EQ(nodes[0].center_m, glm::dvec3(1, 2, 3));
  EXPECT_EQ(nodes[1].name, "bulb");
  EXPECT_EQ(nodes[1].extras, "{\"role\":\"emitter\"}");
  EXPECT_EQ(nodes[1].center_m, glm::dvec3(1.5, 2.5, 3.5));
}

}  // namespace
}  // namespace gnomon::ar
