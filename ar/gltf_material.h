// glTF's metallic-roughness materials as fixed-function ones, display-referred. The mapping and its
// reasons: docs/models.md. Internal to ar/: shows tinygltf.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "ar/gltf_document.h"
#include "raster/shading.h"
#include "raster/texture.h"

namespace gnomon::ar::gltf {

/// Linear light to the sRGB curve (IEC 61966-2-1), a channel at a time; clamped to [0, 1].
glm::vec3 display_from_linear(glm::vec3 linear);

struct Surface {
  raster::Material material;
  std::shared_ptr<const raster::Texture> texture;
  /// The set of texture coordinates (TEXCOORD_n) that the texture uses.
  int texcoord_set = 0;
  bool two_sided = false;
};

/// Reads materials of one document; a picture that several materials use is decoded once.
class Materials {
 public:
  explicit Materials(const Document& document) : document_(document) {}

  /// The surface of material `index`; -1 is glTF's default material. Throws InputError.
  Surface surface(int index, const std::string& place);

 private:
  std::shared_ptr<const raster::Texture> texture(int index, const std::string& place);

  const Document& document_;
  std::map<int, std::shared_ptr<const raster::Texture>> textures_;
};

}  // namespace gnomon::ar::gltf
