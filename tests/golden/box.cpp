#include "golden/box.h"

#include <array>

namespace gnomon::golden {

pipeline::Mesh box(const glm::vec3& half) {
  pipeline::Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 normal(0.0f), u(0.0f), v(0.0f);
      normal[axis] = side;
      u[(axis + 1) % 3] = 1.0f;
      v[(axis + 2) % 3] = side;
      const auto base = static_cast<std::uint32_t>(mesh.positions.size());
      for (const std::array<float, 2>& corner :
           {std::array{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
        mesh.positions.emplace_back((normal + u * corner[0] + v * corner[1]) * half, 1.0f);
        mesh.normals.push_back(normal);
        mesh.texcoords.emplace_back(corner[0] * 1.5f, corner[1] * 1.5f);
      }
      for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(base + i);
    }
  return mesh;
}

}  // namespace gnomon::golden
