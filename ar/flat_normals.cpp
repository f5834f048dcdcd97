#include "ar/flat_normals.h"

#include <glm/geometric.hpp>
#include <utility>

namespace gnomon::ar {

void make_flat(pipeline::Mesh& mesh) {
  pipeline::Mesh flat;
  flat.positions.reserve(mesh.indices.size());
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const std::uint32_t* corner = &mesh.indices[t];
    const glm::dvec3 a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]),
        c(mesh.positions[corner[2]]);
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double length = glm::length(cross);
    const glm::vec3 normal = length > 0.0 ? glm::vec3(cross / length) : glm::vec3(0.0f, 0.0f, 1.0f);
    for (int k = 0; k < 3; ++k) {
      flat.positions.push_back(mesh.positions[corner[k]]);
      flat.normals.push_back(normal);
      if (!mesh.texcoords.empty()) flat.texcoords.push_back(mesh.texcoords[corner[k]]);
      if (!mesh.colors.empty()) flat.colors.push_back(mesh.colors[corner[k]]);
      flat.indices.push_back(static_cast<std::uint32_t>(flat.indices.size()));
    }
  }
  mesh = std::move(flat);
}

}  // namespace gnomon::ar
