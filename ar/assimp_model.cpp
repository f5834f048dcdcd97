#include "ar/assimp_model.h"

#include <assimp/BaseImporter.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/flat_normals.h"

namespace gnomon::ar {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxVertices = 24'000'000;
constexpr std::uint64_t kMaxMaterialBytes = std::uint64_t{16} << 20;
constexpr int kMaxDepth = 64;

[[noreturn]] void fail(const fs::path& path, std::string_view what) {
  throw InputError(fmt::format("{}: {}", one_line(path.string()), one_line(what)));
}

const char* extension_of(MeshFormat format) {
  switch (format) {
    case MeshFormat::off:
      return "off";
    case MeshFormat::stl:
      return "stl";
    case MeshFormat::ply:
      return "ply";
    case MeshFormat::three_ds:
      return "3ds";
    default:
      return "obj";
  }
}

/// A file in memory, to be read only.
class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  explicit MemoryStream(std::vector<std::uint8_t> own) : own_(std::move(own)), bytes_(own_) {}

  std::size_t Read(void* out, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    if (whole > 0) std::memcpy(out, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? at_
                                                      : bytes_.size();
    if (offset > bytes_.size() - from) return aiReturn_FAILURE;
    at_ = from + offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::vector<std::uint8_t> own_;
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// What assimp may see: the mesh itself under a name of its own, and .mtl files of its folder.
class OneFolder : public Assimp::IOSystem {
 public:
  OneFolder(std::string name, std::span<const std::uint8_t> bytes, fs::path folder)
      : name_(std::move(name)), bytes_(bytes), folder_(std::move(folder)) {}

  bool Exists(const char* file) const override {
    return file == name_ || material_path(file).has_value();
  }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char*) override {
    if (file == name_) return new MemoryStream(bytes_);
    const std::optional<fs::path> material = material_path(file);
    if (!material) return nullptr;
    try {
      return new MemoryStream(read_file(*material, kMaxMaterialBytes));
    } catch (const InputError&) {
      return nullptr;
    }
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::optional<fs::path> material_path(const std::string& file) const {
    const std::string name = file.starts_with("./") ? file.substr(2) : file;
    if (!name.ends_with(".mtl") || name.find_first_of("/\\:") != std::string::npos) return {};
    std::error_code error;
    const fs::path path = folder_ / name;
    if (!fs::is_regular_file(fs::symlink_status(path, error))) return {};
    return path;
  }

  std::string name_;
  std::span<const std::uint8_t> bytes_;
  fs::path folder_;
};

glm::dmat4 matrix_of(const aiMatrix4x4& m) {
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2,
          m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

/// All that a vertex has, to the bit.
using VertexKey = std::array<std::uint32_t, 12>;

struct KeyHash {
  std::size_t operator()(const VertexKey& key) const {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::uint32_t word : key) hash = (hash ^ word) * 0x100000001b3u;
    return static_cast<std::size_t>(hash ^ hash >> 32);
  }
};

class Reader {
 public:
  Reader(const aiScene& scene, const fs::path& path) : scene_(scene), path_(path) {}

  ModelFile read() {
    if (scene_.mRootNode != nullptr) add_node(*scene_.mRootNode, glm::dmat4(1.0), 0);
    if (left_out_ > 0)
      result_.notes.push_back(fmt::format("{} points and lines are left out", left_out_));
    if (textures_) result_.notes.emplace_back("textures are left out; glTF has them");
    if (result_.model.parts.empty()) fail(path_, "no triangle in the file");
    return std::move(result_);
  }

 private:
  void add_node(const aiNode& node, const glm::dmat4& world_from_parent, int depth) {
    if (depth > kMaxDepth) fail(path_, fmt::format("nodes nested deeper than {}", kMaxDepth));
    const glm::dmat4 world_from_node = world_from_parent * matrix_of(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes)
        fail(path_, fmt::format("mesh {} is not one of {}", node.mMeshes[i], scene_.mNumMeshes));
      add_mesh(*scene_.mMeshes[node.mMeshes[i]], node.mMeshes[i], world_from_node);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i)
      add_node(*node.mChildren[i], world_from_node, depth + 1);
  }

  void add_mesh(const aiMesh& source, unsigned number, const glm::dmat4& world_from_node) {
    const std::string place = source.mName.length > 0
                                  ? fmt::format("mesh {} '{}'", number, source.mName.C_Str())
                                  : fmt::format("mesh {}", number);
    vertices_ += source.mNumVertices;
    if (vertices_ > kMaxVertices)
      fail(path_, fmt::format("{}: more than {} vertices in all", place, kMaxVertices));
    pipeline::Part part;
    pipeline::Mesh& mesh = part.mesh;
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
      const aiFace& face = source.mFaces[f];
      if (face.mNumIndices != 3) {
        ++left_out_;
        continue;
      }
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= source.mNumVertices)
          fail(path_, fmt::format("{}: index {} of face {} is not below the {} positions", place,
                                  face.mIndices[k], f, source.mNumVertices));
        mesh.indices.push_back(face.mIndices[k]);
      }
    }
    if (mesh.indices.empty()) return;
    const double determinant = glm::determinant(glm::dmat3(world_from_node));
    if (determinant == 0.0) {
      result_.notes.push_back(place + ": left out, it is scaled to nothing");
      return;
    }
    if (determinant < 0.0)
      for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    for (unsigned v = 0; v < source.mNumVertices; ++v)
      mesh.positions.emplace_back(placed(source.mVertices[v], world_from_node, v, place), 1.0f);
    read_colors(source, mesh);
    if (read_normals(source, world_from_node, mesh))
      merge_equal_vertices(mesh);
    else
      make_flat(mesh);
    if (source.mMaterialIndex < scene_.mNumMaterials)
      part.material = material_of(*scene_.mMaterials[source.mMaterialIndex]);
    result_.model.parts.push_back(std::move(part));
  }

  glm::vec3 placed(const aiVector3D& v, const glm::dmat4& world_from_node, unsigned index,
                   const std::string& place) const {
    const glm::vec3 world(world_from_node * glm::dvec4(v.x, v.y, v.z, 1.0));
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(world[c]))
        fail(path_, fmt::format("{}: position {} is {}", place, index, world[c]));
    return world;
  }

  static bool read_normals(const aiMesh& source, const glm::dmat4& world_from_node,
                           pipeline::Mesh& mesh) {
    if (!source.HasNormals()) return false;
    const glm::dmat3 m = glm::transpose(glm::inverse(glm::dmat3(world_from_node)));
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
      const aiVector3D& n = source.mNormals[v];
      const glm::dvec3 normal = m * glm::dvec3(n.x, n.y, n.z);
      const double length = glm::length(normal);
      if (!(length > 1e-12) || !std::isfinite(length)) {
        mesh.normals.clear();
        return false;
      }
      mesh.normals.emplace_back(normal / length);
    }
    return true;
  }

  static void read_colors(const aiMesh& source, pipeline::Mesh& mesh) {
    if (!source.HasVertexColors(0)) return;
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
      const aiColor4D& c = source.mColors[0][v];
      if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b)) {
        mesh.colors.clear();
        return;
      }
      mesh.colors.emplace_back(glm::clamp(glm::vec3(c.r, c.g, c.b), 0.0f, 1.0f), 1.0f);
    }
  }

  /// Fixed function, as the file says it; other models' values are left at a plain grey's.
  raster::Material material_of(const aiMaterial& source) {
    raster::Material material;
    const auto color = [&](const char* key, unsigned type, unsigned index, glm::vec3& to) {
      aiColor3D value;
      if (source.Get(key, type, index, value) != aiReturn_SUCCESS) return;
      const glm::vec3 v(value.r, value.g, value.b);
      if (std::isfinite(v.x + v.y + v.z)) to = glm::clamp(v, 0.0f, 1.0f);
    };
    color(AI_MATKEY_COLOR_DIFFUSE, material.diffuse);
    // As glTF's: the ambient light falls on the same colour. Files say black or white at random.
    material.ambient = material.diffuse;
    color(AI_MATKEY_COLOR_EMISSIVE, material.emission);
    float shininess = 0.0f;
    if (source.Get(AI_MATKEY_SHININESS, shininess) == aiReturn_SUCCESS && shininess >= 1.0f) {
      color(AI_MATKEY_COLOR_SPECULAR, material.specular);
      material.shininess = static_cast<int>(std::min(shininess, 1248.0f));
    }
    textures_ = textures_ || source.GetTextureCount(aiTextureType_DIFFUSE) > 0;
    return material;
  }

  /// Readers give each corner a vertex; those that are equal become one, the first.
  static void merge_equal_vertices(pipeline::Mesh& mesh) {
    std::unordered_map<VertexKey, std::uint32_t, KeyHash> known;
    std::vector<std::uint32_t> merged(mesh.positions.size());
    pipeline::Mesh out;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      VertexKey key{};
      std::size_t at = 0;
      const auto add = [&](const auto& values) {
        for (int c = 0; c < 3; ++c) key[at++] = std::bit_cast<std::uint32_t>(values[c]);
      };
      add(mesh.positions[v]);
      add(mesh.normals[v]);
      if (!mesh.colors.empty()) add(mesh.colors[v]);
      const auto [it, fresh] =
          known.try_emplace(key, static_cast<std::uint32_t>(out.positions.size()));
      merged[v] = it->second;
      if (!fresh) continue;
      out.positions.push_back(mesh.positions[v]);
      out.normals.push_back(mesh.normals[v]);
      if (!mesh.colors.empty()) out.colors.push_back(mesh.colors[v]);
    }
    for (const std::uint32_t index : mesh.indices) out.indices.push_back(merged[index]);
    mesh = std::move(out);
  }

  const aiScene& scene_;
  const fs::path& path_;
  ModelFile result_;
  std::size_t vertices_ = 0, left_out_ = 0;
  bool textures_ = false;
};

/// Takes away every reader but the format's own.
void keep_one_reader(Assimp::Importer& importer, const std::string& extension) {
  const std::size_t wanted = importer.GetImporterIndex(("." + extension).c_str());
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i)
    if (i != wanted) others.push_back(importer.GetImporter(i));
  // A reader that is taken away is nobody's.
  for (Assimp::BaseImporter* other : others)
    if (importer.UnregisterLoader(other) == aiReturn_SUCCESS) delete other;
}

/// assimp's reason, in our words where it means that the file holds no mesh.
std::string refusal_of(std::string_view reason) {
  for (const std::string_view words :
       {"mNumMeshes is 0", "contains no vertices", "Unable to extract mesh data"})
    if (reason.find(words) != std::string_view::npos) return "no triangle in the file";
  return fmt::format("assimp: {}", reason);
}

}  // namespace

ModelFile read_with_assimp(MeshFormat format, std::span<const std::uint8_t> bytes,
                           const fs::path& path) {
  const std::string extension = extension_of(format);
  const std::string name = "mesh." + extension;
  try {
    Assimp::Importer importer;
    keep_one_reader(importer, extension);
    importer.SetIOHandler(new OneFolder(name, bytes, path.parent_path()));
    const aiScene* scene =
        importer.ReadFile(name, aiProcess_ValidateDataStructure | aiProcess_Triangulate);
    if (scene == nullptr) fail(path, refusal_of(importer.GetErrorString()));
    return Reader(*scene, path).read();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail(path, "too large for this machine's memory");
  } catch (const std::exception& error) {
    fail(path, error.what());
  }
}

}  // namespace gnomon::ar
