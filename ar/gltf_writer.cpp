#include "ar/gltf_writer.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/common.hpp>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/image_file.h"

namespace gnomon::ar {

namespace {

double linear_channel(float display) {
  const double v = std::clamp(static_cast<double>(display), 0.0, 1.0);
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::vector<double> linear_from_display(const glm::vec3& c) {
  return {linear_channel(c.x), linear_channel(c.y), linear_channel(c.z)};
}

int wrap_of(raster::Wrap wrap) {
  switch (wrap) {
    case raster::Wrap::clamp_to_edge:
      return TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    case raster::Wrap::mirrored_repeat:
      return TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    default:
      return TINYGLTF_TEXTURE_WRAP_REPEAT;
  }
}

class Writer {
 public:
  explicit Writer(const std::filesystem::path& path) : path_(path) {
    gltf_.asset.version = "2.0";
    gltf_.asset.generator = "gnomon";
    gltf_.buffers.emplace_back();
    gltf_.meshes.emplace_back();
    gltf_.nodes.emplace_back();
    gltf_.nodes[0].mesh = 0;
    gltf_.scenes.emplace_back();
    gltf_.scenes[0].nodes = {0};
    gltf_.defaultScene = 0;
  }

  tinygltf::Model take(const pipeline::Model& model) {
    for (const pipeline::Part& part : model.parts) add(part);
    return std::move(gltf_);
  }

 private:
  void add(const pipeline::Part& part) {
    const pipeline::Mesh& mesh = part.mesh;
    if (mesh.indices.empty()) return;
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = material_of(part);
    std::vector<glm::vec3> positions(mesh.positions.begin(), mesh.positions.end());
    const int at = add_floats(positions, TINYGLTF_TYPE_VEC3);
    glm::vec3 low = positions[0], high = positions[0];
    for (const glm::vec3& p : positions) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    tinygltf::Accessor& accessor = gltf_.accessors[static_cast<std::size_t>(at)];
    accessor.minValues = {low.x, low.y, low.z};
    accessor.maxValues = {high.x, high.y, high.z};
    primitive.attributes["POSITION"] = at;
    if (!mesh.normals.empty())
      primitive.attributes["NORMAL"] = add_floats(mesh.normals, TINYGLTF_TYPE_VEC3);
    if (part.texture && !mesh.texcoords.empty())
      primitive.attributes["TEXCOORD_0"] = add_floats(mesh.texcoords, TINYGLTF_TYPE_VEC2);
    if (!mesh.colors.empty()) {
      std::vector<glm::vec3> linear;
      for (const glm::vec4& c : mesh.colors)
        linear.emplace_back(linear_channel(c.x), linear_channel(c.y), linear_channel(c.z));
      primitive.attributes["COLOR_0"] = add_floats(linear, TINYGLTF_TYPE_VEC3);
    }
    primitive.indices =
        add_accessor(mesh.indices.data(), mesh.indices.size() * sizeof(std::uint32_t),
                     TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, mesh.indices.size(),
                     TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
    gltf_.meshes[0].primitives.push_back(std::move(primitive));
  }

  template <class Vector>
  int add_floats(const std::vector<Vector>& values, int type) {
    return add_accessor(values.data(), values.size() * sizeof(Vector), TINYGLTF_TARGET_ARRAY_BUFFER,
                        values.size(), TINYGLTF_COMPONENT_TYPE_FLOAT, type);
  }

  /// The bytes behind all others, at a multiple of four.
  int add_view(const void* data, std::size_t size, int target) {
    std::vector<unsigned char>& buffer = gltf_.buffers[0].data;
    buffer.resize((buffer.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = size;
    view.target = target;
    const auto* bytes = static_cast<const unsigned char*>(data);
    buffer.insert(buffer.end(), bytes, bytes + size);
    gltf_.bufferViews.push_back(std::move(view));
    return static_cast<int>(gltf_.bufferViews.size()) - 1;
  }

  int add_accessor(const void* data, std::size_t size, int target, std::size_t count,
                   int component_type, int type) {
    tinygltf::Accessor accessor;
    accessor.bufferView = add_view(data, size, target);
    accessor.count = count;
    accessor.componentType = component_type;
    accessor.type = type;
    gltf_.accessors.push_back(std::move(accessor));
    return static_cast<int>(gltf_.accessors.size()) - 1;
  }

  int material_of(const pipeline::Part& part) {
    tinygltf::Material material;
    auto& pbr = material.pbrMetallicRoughness;
    pbr.baseColorFactor = linear_from_display(part.material.diffuse);
    pbr.baseColorFactor.push_back(1.0);
    pbr.metallicFactor = 0.0;
    // The inverse of n = 2 / r^4 - 2.
    pbr.roughnessFactor = std::pow(2.0 / (part.material.shininess + 2.0), 0.25);
    material.emissiveFactor = linear_from_display(part.material.emission);
    material.doubleSided = part.two_sided;
    if (part.texture) pbr.baseColorTexture.index = texture_of(*part.texture);
    gltf_.materials.push_back(std::move(material));
    return static_cast<int>(gltf_.materials.size()) - 1;
  }

  int texture_of(const raster::Texture& texture) {
    const auto [known, fresh] =
        textures_.try_emplace(&texture, static_cast<int>(gltf_.textures.size()));
    if (!fresh) return known->second;
    ar::Image picture{texture.width, texture.height, 3, {}};
    for (const raster::Rgba8& texel : texture.texels)
      picture.pixels.insert(picture.pixels.end(), {texel[0], texel[1], texel[2]});
    const std::vector<std::uint8_t> png = encode_png(picture, path_.string());
    tinygltf::Image image;
    image.bufferView = add_view(png.data(), png.size(), 0);
    image.mimeType = "image/png";
    gltf_.images.push_back(std::move(image));
    tinygltf::Sampler sampler;
    sampler.wrapS = wrap_of(texture.wrap_s);
    sampler.wrapT = wrap_of(texture.wrap_t);
    sampler.magFilter = texture.filter == raster::Filter::nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST
                                                                  : TINYGLTF_TEXTURE_FILTER_LINEAR;
    gltf_.samplers.push_back(std::move(sampler));
    tinygltf::Texture out;
    out.source = static_cast<int>(gltf_.images.size()) - 1;
    out.sampler = static_cast<int>(gltf_.samplers.size()) - 1;
    gltf_.textures.push_back(std::move(out));
    return known->second;
  }

  const std::filesystem::path& path_;
  tinygltf::Model gltf_;
  std::map<const raster::Texture*, int> textures_;
};

}  // namespace

void write_gltf(const std::filesystem::path& path, const pipeline::Model& model, bool binary) {
  tinygltf::Model gltf = Writer(path).take(model);
  tinygltf::TinyGLTF writer;
  // tinygltf does not say when a file cannot be opened or a disk is full: the stream does.
  std::ofstream out(path, std::ios::binary);
  const bool written = writer.WriteGltfSceneToStream(&gltf, out, false, binary);
  out.close();
  if (!written || !out)
    throw InputError(fmt::format("{}: cannot be written", one_line(path.string())));
}

}  // namespace gnomon::ar
