#include "raster/interpolate.h"

namespace gnomon::raster {

namespace {

/// Perspective-correct weights of the mesh triangle's three vertices.
glm::vec3 vertex_weights(const Draw& draw, const SetupTriangle& triangle,
                         const TriangleSource& source, int x, int y) {
  const std::int64_t x_fx = x * std::int64_t{256} + 128, y_fx = y * std::int64_t{256} + 128;
  const double area = static_cast<double>(triangle.area());
  const std::array<double, 3> inverse_w = source.inverse_w(triangle, draw.mesh.indices);
  std::array<double, 3> q;
  for (std::size_t k = 0; k < 3; ++k)
    q[k] = static_cast<double>(triangle.edge(static_cast<int>(k)).at(x_fx, y_fx)) *
           (inverse_w[k] / area);
  const double inverse = 1.0 / ((q[0] + q[1]) + q[2]);
  const double w0 = q[0] * inverse, w1 = q[1] * inverse, w2 = q[2] * inverse;
  if (triangle.piece == SetupTriangle::kWhole)
    return triangle.swapped ? glm::vec3(w0, w2, w1) : glm::vec3(w0, w1, w2);
  const auto& weights = source.pieces[triangle.piece].weights;
  return glm::vec3((weights[0] * w0 + weights[1] * w1) + weights[2] * w2);
}

template <class T>
T weighted(std::span<const T> values, const std::uint32_t* index, const glm::vec3& p) {
  return (values[index[0]] * p.x + values[index[1]] * p.y) + values[index[2]] * p.z;
}

glm::vec3 world_normal(const glm::mat3& m, const glm::vec3& n) {
  glm::vec3 out;
  for (int row = 0; row < 3; ++row)
    out[row] = (m[0][row] * n.x + m[1][row] * n.y) + m[2][row] * n.z;
  return out;
}

glm::vec3 world_position(const glm::mat4& m, const glm::vec4& p) {
  glm::vec3 out;
  for (int row = 0; row < 3; ++row)
    out[row] = (m[0][row] * p.x + m[1][row] * p.y) + (m[2][row] * p.z + m[3][row] * p.w);
  return out;
}

}  // namespace

Fragment vertex_attributes(const MeshView& mesh, const Lit& lit, std::size_t vertex) noexcept {
  Fragment out;
  out.normal = world_normal(lit.world_from_model_normal, mesh.normals[vertex]);
  out.world = world_position(lit.world_from_model, mesh.positions[vertex]);
  if (!mesh.colors.empty()) out.color = mesh.colors[vertex];
  return out;
}

Fragment interpolate(const Draw& draw, const SetupTriangle& triangle, const TriangleSource& source,
                     int x, int y) noexcept {
  Fragment fragment;
  fragment.front_facing = triangle.front_facing;
  const MeshView& mesh = draw.mesh;
  const Lit* lit = std::get_if<Lit>(&draw.shading);
  const Flat* flat = std::get_if<Flat>(&draw.shading);
  if (flat && mesh.colors.empty() && !flat->texture && !flat->depth_lookup) return fragment;

  const glm::vec3 p = vertex_weights(draw, triangle, source, x, y);
  const std::uint32_t* index = mesh.indices.data() + triangle.first_index;
  const std::span<const glm::vec4> colors = source.colors.of(triangle.front_facing);
  if (!colors.empty()) fragment.color = weighted(colors, index, p);
  if (!mesh.texcoords.empty()) fragment.texcoord = weighted(mesh.texcoords, index, p);
  if (flat && flat->depth_lookup) fragment.model = weighted(mesh.positions, index, p);
  if (lit && !lit->at_vertices) {
    fragment.normal = world_normal(lit->world_from_model_normal, weighted(mesh.normals, index, p));
    fragment.world = world_position(lit->world_from_model, weighted(mesh.positions, index, p));
  }
  return fragment;
}

}  // namespace gnomon::raster
