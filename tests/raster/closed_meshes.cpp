#include "closed_meshes.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

namespace gnomon::closed_meshes {

namespace {

using random_frames::Random;

glm::vec3 random_point(Random& random) {
  const float x = random.real(-1.0f, 1.0f), y = random.real(-1.0f, 1.0f);
  return {x, y, random.real(-1.0f, 1.0f)};
}

ClosedMesh icosahedron() {
  const float g = 1.618034f;
  ClosedMesh mesh;
  for (const float a : {-1.0f, 1.0f})
    for (const float b : {-g, g})
      for (const glm::vec3& p : {glm::vec3{0, a, b}, {a, b, 0}, {b, 0, a}})
        mesh.positions.push_back({glm::normalize(p), 1.0f});
  // Three vertices of which each two are 2 apart, before they were normalised, make a face.
  const auto apart = [&](std::uint32_t i, std::uint32_t k) {
    return glm::distance(mesh.positions[i], mesh.positions[k]) < 1.1f;
  };
  for (std::uint32_t i = 0; i < 12; ++i)
    for (std::uint32_t k = i + 1; k < 12; ++k)
      for (std::uint32_t l = k + 1; l < 12; ++l) {
        if (!apart(i, k) || !apart(k, l) || !apart(l, i)) continue;
        const glm::vec3 a(mesh.positions[i]), b(mesh.positions[k]), c(mesh.positions[l]);
        const bool outwards = glm::dot(glm::cross(b - a, c - a), a) > 0.0f;
        mesh.indices.insert(mesh.indices.end(), {i, outwards ? k : l, outwards ? l : k});
      }
  return mesh;
}

ClosedMesh subdivided(const ClosedMesh& mesh) {
  ClosedMesh out{mesh.positions, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t i, std::uint32_t k) {
    const auto [at, added] =
        middles.try_emplace(std::minmax(i, k), static_cast<std::uint32_t>(out.positions.size()));
    if (added)
      out.positions.push_back(
          {glm::normalize(glm::vec3(mesh.positions[i]) + glm::vec3(mesh.positions[k])), 1.0f});
    return at->second;
  };
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const std::uint32_t a = mesh.indices[t], b = mesh.indices[t + 1], c = mesh.indices[t + 2];
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    out.indices.insert(out.indices.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
  }
  return out;
}

ClosedMesh tetrahedron(Random& random) {
  ClosedMesh mesh{{}, {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2}};
  for (int i = 0; i < 4; ++i) mesh.positions.push_back({random_point(random), 1.0f});
  return mesh;
}

ClosedMesh parallelepiped(Random& random) {
  const glm::vec3 a = random_point(random), b = random_point(random), c = random_point(random);
  ClosedMesh mesh;
  for (const float u : {-1.0f, 1.0f})
    for (const float v : {-1.0f, 1.0f})
      for (const float w : {-1.0f, 1.0f})
        mesh.positions.push_back({(u * a + v * b + w * c) / 3.0f, 1.0f});
  for (const std::array<std::uint32_t, 4>& q : {std::array<std::uint32_t, 4>{0, 1, 3, 2},
                                                {4, 6, 7, 5},
                                                {0, 4, 5, 1},
                                                {2, 3, 7, 6},
                                                {0, 2, 6, 4},
                                                {1, 5, 7, 3}})
    mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
  return mesh;
}

}  // namespace

ClosedMesh dented_sphere(Random& random, int subdivisions) {
  ClosedMesh mesh = icosahedron();
  for (int i = 0; i < subdivisions; ++i) mesh = subdivided(mesh);
  for (glm::vec4& p : mesh.positions) p = {random.real(0.3f, 1.0f) * glm::vec3(p), 1.0f};
  return mesh;
}

ClosedMesh random_mesh(Random& random, const glm::vec3& centre, float radius) {
  ClosedMesh mesh;
  switch (random.integer(0, 2)) {
    case 0:
      mesh = tetrahedron(random);
      break;
    case 1:
      mesh = parallelepiped(random);
      break;
    default:
      mesh = dented_sphere(random, random.integer(0, 2));
  }
  // Corners of the cube of random points are sqrt(3) away.
  for (glm::vec4& p : mesh.positions) p = {centre + radius / 1.7321f * glm::vec3(p), 1.0f};
  return mesh;
}

ClosedMesh shadow_volumes(const ClosedMesh& mesh, const glm::vec4& light) {
  ClosedMesh out;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const auto corner = [&](std::size_t i) {
      return glm::vec3(mesh.positions[mesh.indices[t + i]]);
    };
    const glm::vec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    if (glm::dot(normal, glm::vec3(light) - light.w * corner(0)) <= 0.0f) continue;
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (std::size_t i = 0; i < 3; ++i) out.positions.push_back({corner(i), 1.0f});
    for (std::size_t i = 0; i < 3; ++i)
      out.positions.push_back({light.w * corner(i) - glm::vec3(light), 0.0f});
    for (const std::uint32_t i :
         {0, 1, 2, 3, 5, 4, 1, 0, 3, 1, 3, 4, 2, 1, 4, 2, 4, 5, 0, 2, 5, 0, 5, 3})
      out.indices.push_back(first + i);
  }
  return out;
}

}  // namespace gnomon::closed_meshes
