#include "ar/gltf_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "ar/error.h"
#include "ar/image_file.h"

namespace gnomon::ar::gltf {

namespace {

constexpr float kDielectricReflectance = 0.04f;

float display_channel(float linear) {
  const float v = std::clamp(linear, 0.0f, 1.0f);
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

glm::vec3 color_of(const Document& document, const std::vector<double>& values,
                   const std::string& place) {
  if (values.size() < 3 || values.size() > 4)
    fail(document.path, fmt::format("{}: {} values for a colour", place, values.size()));
  for (const double value : values)
    if (!(value >= 0.0 && value <= 1.0))
      fail(document.path, fmt::format("{}: {} is not within 0 to 1", place, value));
  return {values[0], values[1], values[2]};
}

float unit_of(const Document& document, double value, const std::string& place) {
  if (!(value >= 0.0 && value <= 1.0))
    fail(document.path, fmt::format("{}: {} is not within 0 to 1", place, value));
  return static_cast<float>(value);
}

raster::Wrap wrap_of(int mode) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return raster::Wrap::clamp_to_edge;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return raster::Wrap::mirrored_repeat;
    default:
      return raster::Wrap::repeat;
  }
}

/// The highlight of Blinn and Phong with the width of a microfacet one: exponent 2 / a^2 - 2 for
/// a = roughness^2 (Walter et al. 2007, section 5.2); its height keeps the energy of exponent 0
/// (Akenine-Moeller et al., Real-Time Rendering: (n + 8) / 8).
void set_highlight(raster::Material& material, glm::vec3 base, float metallic, float roughness) {
  const float alpha = roughness * roughness;
  const float exponent = alpha < 0.04f ? 1248.0f : 2.0f / (alpha * alpha) - 2.0f;
  material.shininess = static_cast<int>(std::lround(exponent));
  if (material.shininess < 1) return;
  const glm::vec3 reflectance =
      glm::vec3(kDielectricReflectance) * (1.0f - metallic) + base * metallic;
  const float height = (static_cast<float>(material.shininess) + 8.0f) / 8.0f;
  for (int c = 0; c < 3; ++c) material.specular[c] = std::min(1.0f, reflectance[c] * height);
}

}  // namespace

glm::vec3 display_from_linear(glm::vec3 linear) {
  return {display_channel(linear.x), display_channel(linear.y), display_channel(linear.z)};
}

std::shared_ptr<const raster::Texture> Materials::texture(int index, const std::string& place) {
  if (const auto known = textures_.find(index); known != textures_.end()) return known->second;
  const tinygltf::Model& gltf = document_.gltf;
  const auto check = [&](int i, std::size_t size, const char* what) {
    if (i < 0 || static_cast<std::size_t>(i) >= size)
      fail(document_.path, fmt::format("{}: {} {} is not one of {}", place, what, i, size));
    return static_cast<std::size_t>(i);
  };
  const tinygltf::Texture& t = gltf.textures[check(index, gltf.textures.size(), "texture")];
  const std::size_t source = check(t.source, gltf.images.size(), "image");
  const tinygltf::Image& stored = gltf.images[source];
  const std::string name = fmt::format("{}: image {}", document_.path.string(), source);
  Bytes bytes{stored.image.data(), stored.image.size()};
  if (stored.bufferView >= 0)
    bytes = view_bytes(document_, stored.bufferView, fmt::format("image {}", source));
  if (bytes.size == 0)
    throw InputError(fmt::format("{}: \"{}\" cannot be read from the model's folder", name,
                                 stored.uri.substr(0, 100)));
  const Image image = decode_image(std::span(bytes.data, bytes.size), name);

  raster::Texture texture{.width = image.width, .height = image.height};
  texture.texels.reserve(static_cast<std::size_t>(image.width) * image.height);
  // glTF's (0, 0) is the picture's top left corner, so its rows are the texture's.
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.at(x, y);
      const int g = image.channels == 1 ? 0 : 1;
      // Opaque: alphaMode is not used.
      texture.texels.push_back({p[0], p[g], p[2 * g], 255});
    }
  if (t.sampler >= 0) {
    const tinygltf::Sampler& sampler =
        gltf.samplers[check(t.sampler, gltf.samplers.size(), "sampler")];
    texture.wrap_s = wrap_of(sampler.wrapS);
    texture.wrap_t = wrap_of(sampler.wrapT);
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST)
      texture.filter = raster::Filter::nearest;
  }
  return textures_[index] = std::make_shared<const raster::Texture>(std::move(texture));
}

Surface Materials::surface(int index, const std::string& place) {
  const auto& materials = document_.gltf.materials;
  Surface surface;
  if (index == -1) {
    surface.material.ambient = surface.material.diffuse = glm::vec3(1.0f);
    return surface;
  }
  if (index < 0 || static_cast<std::size_t>(index) >= materials.size())
    fail(document_.path,
         fmt::format("{}: material {} is not one of {}", place, index, materials.size()));
  const tinygltf::Material& m = materials[static_cast<std::size_t>(index)];
  const auto& pbr = m.pbrMetallicRoughness;
  const std::string where = fmt::format("material {}", index);
  const glm::vec3 base =
      display_from_linear(color_of(document_, pbr.baseColorFactor, where + ": baseColorFactor"));
  surface.material.ambient = surface.material.diffuse = base;
  surface.material.emission =
      display_from_linear(color_of(document_, m.emissiveFactor, where + ": emissiveFactor"));
  set_highlight(surface.material, base,
                unit_of(document_, pbr.metallicFactor, where + ": metallicFactor"),
                unit_of(document_, pbr.roughnessFactor, where + ": roughnessFactor"));
  surface.two_sided = m.doubleSided;
  if (pbr.baseColorTexture.index >= 0) {
    surface.texture = texture(pbr.baseColorTexture.index, where + ": baseColorTexture");
    surface.texcoord_set = pbr.baseColorTexture.texCoord;
  }
  return surface;
}

}  // namespace gnomon::ar::gltf
