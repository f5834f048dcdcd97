#include "ar/model_writer.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <cctype>
#include <memory>
#include <string>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/gltf_writer.h"

namespace gnomon::ar {
namespace {

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// assimp's name of the format, or null.
const char* assimp_format(const std::string& extension) {
  if (extension == ".obj") return "objnomtl";
  if (extension == ".ply") return "plyb";
  if (extension == ".stl") return "stlb";
  return nullptr;
}

std::unique_ptr<aiMesh> mesh_of(const pipeline::Mesh& mesh) {
  auto out = std::make_unique<aiMesh>();
  out->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  out->mNumVertices = static_cast<unsigned>(mesh.positions.size());
  out->mVertices = new aiVector3D[mesh.positions.size()];
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    out->mVertices[v] = {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z};
  if (!mesh.normals.empty()) {
    out->mNormals = new aiVector3D[mesh.normals.size()];
    for (std::size_t v = 0; v < mesh.normals.size(); ++v)
      out->mNormals[v] = {mesh.normals[v].x, mesh.normals[v].y, mesh.normals[v].z};
  }
  out->mNumFaces = static_cast<unsigned>(mesh.triangle_count());
  out->mFaces = new aiFace[mesh.triangle_count()];
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    out->mFaces[t].mNumIndices = 3;
    out->mFaces[t].mIndices = new unsigned[3];
    for (std::size_t k = 0; k < 3; ++k) out->mFaces[t].mIndices[k] = mesh.indices[3 * t + k];
  }
  return out;
}

/// One node with all parts. The scene owns what it points to.
std::unique_ptr<aiScene> scene_of(const pipeline::Model& model) {
  auto scene = std::make_unique<aiScene>();
  scene->mRootNode = new aiNode;
  scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
  scene->mNumMaterials = 1;
  const auto count = static_cast<unsigned>(model.parts.size());
  scene->mMeshes = new aiMesh* [count] {};
  scene->mNumMeshes = count;
  scene->mRootNode->mMeshes = new unsigned[count];
  scene->mRootNode->mNumMeshes = count;
  for (unsigned i = 0; i < count; ++i) {
    scene->mMeshes[i] = mesh_of(model.parts[i].mesh).release();
    scene->mRootNode->mMeshes[i] = i;
  }
  return scene;
}

}  // namespace

void check_written_extension(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".glb" || extension == ".gltf" || assimp_format(extension) != nullptr) return;
  throw InputError(fmt::format("{}: '{}' is no format that is written; {} are",
                               one_line(path.string()), one_line(path.extension().string()),
                               kWrittenExtensions));
}

void write_model(const std::filesystem::path& path, const pipeline::Model& model) {
  check_written_extension(path);
  const std::string extension = extension_of(path);
  if (const char* format = assimp_format(extension)) {
    Assimp::Exporter exporter;
    const std::unique_ptr<aiScene> scene = scene_of(model);
    if (exporter.Export(scene.get(), format, path.string()) != aiReturn_SUCCESS)
      throw InputError(fmt::format("{}: cannot be written: {}", one_line(path.string()),
                                   one_line(exporter.GetErrorString())));
    return;
  }
  write_gltf(path, model, extension == ".glb");
}

}  // namespace gnomon::ar
