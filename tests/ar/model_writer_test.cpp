// Models written and read again. Oracles: the model itself, and the documented mapping of
// materials.
#include "ar/model_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "ar/error.h"
#include "ar/model_file.h"
#include "pipeline/mesh_check.h"
#include "tests/ar/temporary_folder.h"

namespace gnomon::ar {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kSource = GNOMON_SOURCE_DIR;

std::vector<std::array<float, 9>> triangles_of(const pipeline::Model& model) {
  std::vector<std::array<float, 9>> triangles;
  for (const pipeline::Part& part : model.parts)
    for (std::size_t i = 0; i < part.mesh.indices.size(); i += 3) {
      std::array<float, 9> t{};
      for (std::size_t k = 0; k < 9; ++k)
        t[k] = part.mesh.positions[part.mesh.indices[i + k / 3]][static_cast<int>(k % 3)];
      triangles.push_back(t);
    }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TEST(ModelWriter, PositionsKeepTheirBits) {
  const TemporaryFolder folder;
  for (const char* model : {"examples/desk/virtual/torus.glb", "examples/desk/phantoms/house.glb",
                            "tests/data/gltf/good/alien_kenney.glb"}) {
    const ModelFile file = load_model(kSource / model);
    for (const char* name : {"out.glb", "out.gltf", "out.ply", "out.stl"}) {
      write_model(folder.path() / name, file.model);
      EXPECT_EQ(triangles_of(load_model(folder.path() / name).model), triangles_of(file.model))
          << model << ' ' << name;
    }
  }
}

TEST(ModelWriter, ObjKeepsWhatIsClosedClosed) {
  const TemporaryFolder folder;
  const ModelFile file = load_model(kSource / "examples/desk/virtual/torus.glb");
  write_model(folder.path() / "out.obj", file.model);
  const pipeline::MeshCheck check =
      pipeline::check_mesh(load_model(folder.path() / "out.obj").model);
  EXPECT_TRUE(check.casts_classical_volume());
  EXPECT_EQ(check.triangles, file.model.parts.at(0).mesh.triangle_count());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << "no file beside";
}

TEST(ModelWriter, GltfKeepsMaterialNormalsColoursAndTexture) {
  const TemporaryFolder folder;
  auto texture = std::make_shared<raster::Texture>();
  texture->width = 2;
  texture->height = 1;
  texture->texels = {{255, 0, 0, 255}, {0, 200, 100, 255}};
  texture->wrap_s = raster::Wrap::mirrored_repeat;
  texture->filter = raster::Filter::nearest;
  pipeline::Model model;
  model.parts.push_back({.mesh = {.positions = {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}},
                                  .indices = {0, 1, 2},
                                  .normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
                                  .texcoords = {{0, 0}, {0.25f, 1}, {0.5f, 0}},
                                  .colors = {{1, 0, 0, 1}, {0, 0.5f, 0, 1}, {0, 0, 0.75f, 1}}},
                         .texture = texture,
                         .two_sided = true});
  raster::Material& material = model.parts[0].material;
  material.diffuse = {0.25f, 0.5f, 0.75f};
  material.emission = {0.1f, 0.0f, 0.0f};
  material.shininess = 30;
  for (const char* name : {"out.glb", "out.gltf"}) {
    write_model(folder.path() / name, model);
    const pipeline::Part part = load_model(folder.path() / name).model.parts.at(0);
    EXPECT_EQ(part.mesh.normals, model.parts[0].mesh.normals);
    EXPECT_EQ(part.mesh.texcoords, model.parts[0].mesh.texcoords);
    EXPECT_TRUE(part.two_sided);
    for (int c = 0; c < 3; ++c) {
      // Through the sRGB curve and back in float.
      EXPECT_NEAR(part.material.diffuse[c], material.diffuse[c], 1e-5f);
      EXPECT_NEAR(part.material.emission[c], material.emission[c], 1e-5f);
      EXPECT_NEAR(part.mesh.colors.at(2)[c], model.parts[0].mesh.colors[2][c], 1e-5f);
    }
    EXPECT_EQ(part.material.shininess, 30);
    ASSERT_NE(part.texture, nullptr);
    EXPECT_EQ(part.texture->texels, texture->texels);
    EXPECT_EQ(part.texture->wrap_s, texture->wrap_s);
    EXPECT_EQ(part.texture->filter, texture->filter);
  }
}

TEST(ModelWriter, OtherFormatsAndFoldersThatAreNotThereAreRefused) {
  const TemporaryFolder folder;
  const ModelFile file = load_model(kSource / "tests/data/gltf/good/Box.glb");
  for (const auto& [path, part] :
       {std::pair<fs::path, std::string>{folder.path() / "out.fbx", "'.fbx' is no format"},
        {folder.path() / "none/out.glb", "cannot be written"},
        {folder.path() / "none/out.ply", "cannot be written"}}) {
    try {
      write_model(path, file.model);
      ADD_FAILURE() << path;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(part));
      EXPECT_THAT(e.what(), HasSubstr(path.filename().string()));
    }
  }
}

}  // namespace
}  // namespace gnomon::ar
