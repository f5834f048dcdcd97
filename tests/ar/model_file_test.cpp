// Models of every format that is read. Oracles: a cube written down in each of them, counts taken
// by another program, and the contract: a sound model or one line that names the file.
#include "ar/model_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/scene_file.h"
#include "ar/scene_models.h"
#include "pipeline/mesh_check.h"
#include "tests/ar/cube_files.h"
#include "tests/ar/model_checks.h"
#include "tests/ar/temporary_folder.h"

namespace gnomon::ar {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

const fs::path kData = fs::path(GNOMON_SOURCE_DIR) / "tests/data/mesh";

/// What load_model promises of every model.
void expect_sound(const pipeline::Model& model) {
  ASSERT_FALSE(model.parts.empty());
  for (const pipeline::Part& part : model.parts) {
    const pipeline::Mesh& mesh = part.mesh;
    test::expect_sound_mesh(mesh);
    if (::testing::Test::HasFatalFailure()) return;
    for (const glm::vec4& c : mesh.colors)
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(c[k] >= 0.0f && c[k] <= 1.0f);
  }
}

std::string message_of(const fs::path& path) {
  try {
    load_model(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

class ModelFileTest : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& bytes) const {
    write_file(folder_.path() / name, bytes);
    return folder_.path() / name;
  }
  void expect_refused(const fs::path& path, const std::string& part) const {
    const std::string message = message_of(path);
    EXPECT_THAT(message, HasSubstr(path.filename().string() + ": "));
    EXPECT_THAT(message, HasSubstr(part));
    EXPECT_THAT(message, Not(HasSubstr("\n")));
  }
  const TemporaryFolder folder_;
};

TEST_F(ModelFileTest, TheSameCubeInEveryFormat) {
  for (const auto& [name, bytes] : test::cube_files()) {
    const ModelFile file = load_model(write(name, bytes));
    expect_sound(file.model);
    const pipeline::MeshCheck check = pipeline::check_mesh(file.model);
    EXPECT_EQ(check.triangles, 12u) << name;
    EXPECT_EQ(check.welded_vertices, 8u) << name;
    EXPECT_TRUE(check.casts_classical_volume()) << name;
    EXPECT_NEAR(test::volume6(file.model), 6.0 * 8.0, 1e-5) << name << ": outwards, of edge 2";
  }
}

TEST_F(ModelFileTest, ContentsDecideWhereTheySayTheFormat) {
  const auto cubes = test::cube_files();
  for (const char* name :
       {"ascii.ply", "binary.ply", "ascii.stl", "binary.stl", "cube.off", "cube.3ds"}) {
    const ModelFile file = load_model(write(std::string(name) + ".obj", cubes.at(name)));
    EXPECT_NEAR(test::volume6(file.model), 48.0, 1e-5) << name;
  }
  const fs::path glb = fs::path(GNOMON_SOURCE_DIR) / "tests/data/gltf/good/Box.glb";
  EXPECT_EQ(load_model(write("box.obj",
                             [&] {
                               const auto bytes = read_file(glb, 1 << 20);
                               return std::string(bytes.begin(), bytes.end());
                             }()))
                .model.parts.size(),
            1u);
  expect_refused(write("cube.xyz", cubes.at("cube.obj")), "'.xyz' is no model format");
  EXPECT_NEAR(test::volume6(load_model(write("CUBE.OBJ", cubes.at("cube.obj"))).model), 48.0, 1e-5);
}

// Oracle: counts that another program took.
TEST(ModelFile, FaultsOfKnownMeshesAreThoseThatAnotherProgramCounted) {
  std::ifstream table(kData / "topology.tsv");
  std::string line;
  std::getline(table, line);
  int rows = 0;
  while (std::getline(table, line)) {
    std::istringstream row(line);
    std::string name;
    std::size_t triangles = 0, welded = 0, open = 0, non_manifold = 0, misoriented = 0,
                duplicate = 0;
    row >> name >> triangles >> welded >> open >> non_manifold >> misoriented >> duplicate;
    ASSERT_TRUE(row) << line;
    const ModelFile file = load_model(kData / "good" / name);
    expect_sound(file.model);
    const pipeline::MeshCheck check = pipeline::check_mesh(file.model);
    EXPECT_EQ(check.triangles, triangles) << name;
    EXPECT_EQ(check.welded_vertices, welded) << name;
    EXPECT_EQ(check.open_edges.count, open) << name;
    EXPECT_EQ(check.non_manifold_edges.count, non_manifold) << name;
    EXPECT_EQ(check.misoriented_edges.count, misoriented) << name;
    EXPECT_EQ(check.duplicate_triangles.count, duplicate) << name;
    ++rows;
  }
  EXPECT_EQ(rows, 8);
}

// Oracle: topology of glTF meshes counted the same way, each mesh once.
TEST(ModelFile, GltfMeshesHaveTheirKnownTopology) {
  struct Expected {
    const char* file;
    std::size_t triangles, open, non_manifold;
  };
  const fs::path good = fs::path(GNOMON_SOURCE_DIR) / "tests/data/gltf/good";
  for (const Expected& e :
       {Expected{"Box.glb", 12, 0, 0}, Expected{"BoxInterleaved.glb", 12, 0, 0},
        Expected{"BoxTextured.glb", 12, 0, 0}, Expected{"box_sparse.glb", 12, 0, 0},
        Expected{"gltf_primitives.glb", 12, 0, 0}, Expected{"boxNotManifold.glb", 12, 4, 0},
        Expected{"CornellBox.glb", 36, 8, 0}, Expected{"SimpleSkin.gltf", 8, 10, 0},
        Expected{"no_indices_3storybuilding.glb", 72, 0, 26}}) {
    const pipeline::MeshCheck check = pipeline::check_mesh(load_model(good / e.file).model);
    EXPECT_EQ(check.triangles, e.triangles) << e.file;
    EXPECT_EQ(check.open_edges.count, e.open) << e.file;
    EXPECT_EQ(check.non_manifold_edges.count, e.non_manifold) << e.file;
  }
}

TEST(ModelFile, QuirksOfObjFilesAreRead) {
  // Indices from the end, a colour that is no number, a material file that is not there, lines
  // that go on, a group without a face.
  for (const char* name : {"negative_indices.obj", "nancolor.obj", "jacked.obj"})
    EXPECT_EQ(pipeline::check_mesh(load_model(kData / "good" / name).model).welded_vertices, 8u)
        << name;
  const pipeline::MeshCheck hole =
      pipeline::check_mesh(load_model(kData / "good/wallhole_line_continuation.obj").model);
  EXPECT_EQ(hole.triangles, 66u);
  EXPECT_EQ(hole.open_edges.count, 0u);
  EXPECT_EQ(pipeline::check_mesh(load_model(kData / "good/obj_with_no_face_in_chunk.obj").model)
                .triangles,
            1u);
}

TEST_F(ModelFileTest, ObjMaterialComesFromItsOwnFolderOnly) {
  const std::string cube = test::cube_files().at("cube.obj");
  fs::create_directories(folder_.path() / "inner");
  write("red.mtl", "newmtl red\nKd 1 0 0\nNs 30\nKs 0.5 0.5 0.5\n");
  const ModelFile red = load_model(write("cube.obj", "mtllib red.mtl\nusemtl red\n" + cube));
  EXPECT_EQ(red.model.parts.at(0).material.diffuse, glm::vec3(1, 0, 0));
  EXPECT_EQ(red.model.parts.at(0).material.shininess, 30);
  for (const std::string& name :
       {std::string("../red.mtl"), (folder_.path() / "red.mtl").string()}) {
    const ModelFile plain =
        load_model(write("inner/cube.obj", "mtllib " + name + "\nusemtl red\n" + cube));
    EXPECT_NE(plain.model.parts.at(0).material.diffuse, glm::vec3(1, 0, 0)) << name;
  }
  fs::create_symlink(folder_.path() / "red.mtl", folder_.path() / "inner/link.mtl");
  const ModelFile link =
      load_model(write("inner/cube.obj", "mtllib link.mtl\nusemtl red\n" + cube));
  EXPECT_NE(link.model.parts.at(0).material.diffuse, glm::vec3(1, 0, 0));
}

TEST_F(ModelFileTest, VertexColoursOfPlyAreKept) {
  const ModelFile file = load_model(write(
      "colours.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
      "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 "
      "1 0 0 0 51\n3 0 1 2\n"));
  const pipeline::Mesh& mesh = file.model.parts.at(0).mesh;
  ASSERT_EQ(mesh.colors.size(), 3u);
  EXPECT_EQ(mesh.colors[0], glm::vec4(1, 0, 0, 1));
  EXPECT_NEAR(mesh.colors[2].z, 0.2f, 1e-6f);
}

TEST(ModelFile, FilesWithoutATriangleAreRefused) {
  for (const auto& entry : fs::directory_iterator(kData / "bad")) {
    const std::string message = message_of(entry.path());
    EXPECT_THAT(message, HasSubstr(entry.path().filename().string())) << entry.path();
    EXPECT_THAT(message, Not(HasSubstr("\n")));
    if (entry.path().stem() == "empty") {
      EXPECT_THAT(message, HasSubstr("no triangle in the file"));
    }
  }
}

TEST_F(ModelFileTest, PromisesThatTheBytesDoNotKeepAreRefused) {
  const auto cubes = test::cube_files();
  const auto changed = [&](const std::string& name, const std::string& from,
                           const std::string& to) {
    std::string text = cubes.at(name);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  std::string many = cubes.at("binary.stl");
  many[83] = '\x40';
  expect_refused(write("many.stl", many), "1073741836 triangles of a binary STL file");
  expect_refused(write("short.stl", cubes.at("binary.stl").substr(0, 300)), "but the file has 300");
  expect_refused(write("tiny.stl", "abc"), "3 bytes are no STL file");
  expect_refused(write("many.ply", changed("ascii.ply", "vertex 8", "vertex 4000000000")),
                 "4000000000 of element vertex are announced, 20 are there");
  expect_refused(write("many2.ply", changed("binary.ply", "face 12", "face 99999999999")),
                 "99999999999 of element face are announced, 12 are there");
  expect_refused(write("sign.ply", changed("ascii.ply", "vertex 8", "vertex -8")),
                 "'-8' is no count");
  expect_refused(write("type.ply", changed("ascii.ply", "float x", "quad x")), "unknown type");
  expect_refused(write("header.ply", cubes.at("ascii.ply").substr(0, 60)), "no end_header");
  expect_refused(write("kind.ply", changed("ascii.ply", "format ascii", "format roman")),
                 "format 'roman'");
  expect_refused(write("many.off", changed("cube.off", "8 12 0", "800000000 12 0")),
                 "800000000 vertices are announced, 20 are there");
  expect_refused(write("words.off", changed("cube.off", "8 12 0", "eight 12 0")),
                 "'eight' is no count");
  expect_refused(write("colour.off", "C" + cubes.at("cube.off")), "COFF");
  std::string chunk = cubes.at("cube.3ds");
  chunk[8] = '\xff';
  chunk[9] = '\xff';
  expect_refused(write("chunk.3ds", chunk), "3DS: chunk");
  expect_refused(write("nul.obj", std::string("v 0 0 0\0\n", 9)), "bytes that are no text");
  expect_refused(folder_.path() / "none.obj", "no such file");
  expect_refused(folder_.path(), "not a regular file");
}

TEST_F(ModelFileTest, IndicesAndPositionsAreChecked) {
  expect_refused(write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "");
  expect_refused(write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "");
  expect_refused(write("inf.off", "OFF\n3 1 0\n0 0 0\n1e39 0 0\n0 1 0\n3 0 1 2\n"), "");
  expect_refused(write("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"), "");
  expect_refused(write("index.ply",
                       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
                       "y\nproperty float z\nelement face 1\nproperty list uchar int "
                       "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
                 "");
}

class DamagedModelFile : public ModelFileTest, public ::testing::WithParamInterface<const char*> {};

// Oracle: a sound model or an InputError that names the file; run under ASan too.
TEST_P(DamagedModelFile, NeverCrashesAndAlwaysEnds) {
  const std::string name = GetParam(), bytes = test::cube_files().at(name);
  std::size_t refused = 0, read = 0;
  const auto attempt = [&](const std::string& damaged) {
    const fs::path path = write(name, damaged);
    try {
      expect_sound(load_model(path).model);
      ++read;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(name));
      ++refused;
    }
  };
  for (std::size_t length = 0; length < bytes.size(); length += 2) attempt(bytes.substr(0, length));
  constexpr int kChanges[] = {0xff, 0x01, 0x10};
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ kChanges[at % 3]);
    attempt(damaged);
  }
  EXPECT_GT(refused, 20u);
  EXPECT_GT(read, 20u);
}

INSTANTIATE_TEST_SUITE_P(EachFormat, DamagedModelFile,
                         ::testing::Values("cube.obj", "cube.off", "ascii.stl", "binary.stl",
                                           "ascii.ply", "binary.ply", "cube.3ds"),
                         [](const auto& format) {
                           std::string name = format.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST_F(ModelFileTest, SceneTakesAModelOfAnyFormat) {
  SceneFile scene;
  write("cube.off", test::cube_files().at("cube.off"));
  scene.objects.push_back({.name = "cube", .model = folder_.path() / "cube.off"});
  const auto models = load_models(scene);
  EXPECT_NEAR(test::volume6(*models.at(0).model), 48.0, 1e-5);
}

}  // namespace
}  // namespace gnomon::ar
