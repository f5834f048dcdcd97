#include "pipeline/reduced_occluder.h"

#include <limits>
#include <utility>
#include <vector>

#include <meshoptimizer.h>

#include "pipeline/surface_distance.h"
#include "pipeline/topology.h"
#include "raster/check.h"

namespace gnomon::pipeline {

ReducedOccluder reduce_occluder(const std::shared_ptr<const Model>& model, std::size_t triangles) {
  raster::require(triangles > 0, "a reduced occluder has triangles");
  const Topology topology = build_topology(*model);
  if (topology.indices.size() <= 3 * triangles) return {model, 0.0};
  std::vector<float> positions;
  positions.reserve(3 * topology.positions.size());
  for (const glm::vec4& p : topology.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
  std::vector<std::uint32_t> indices(topology.indices.size());
  indices.resize(meshopt_simplify(indices.data(), topology.indices.data(), topology.indices.size(),
                                  positions.data(), topology.positions.size(), 3 * sizeof(float),
                                  3 * triangles, std::numeric_limits<float>::max(), 0, nullptr));
  if (indices.empty()) return {model, 0.0};
  Part part;
  std::vector<glm::vec4>& kept = part.mesh.positions;
  kept.resize(topology.positions.size());
  kept.resize(meshopt_optimizeVertexFetch(kept.data(), indices.data(), indices.size(),
                                          topology.positions.data(), topology.positions.size(),
                                          sizeof(glm::vec4)));
  part.mesh.indices = std::move(indices);
  auto reduced = std::make_shared<Model>();
  reduced->parts.push_back(std::move(part));
  return {reduced, surface_distance(*model, *reduced)};
}

void ReducedOccluders::apply(Scene& scene) {
  if (triangles_ == 0) return;
  for (Object& object : scene.objects) {
    if (!object.casts || object.shadow_model) continue;
    const auto [at, is_new] = known_.try_emplace(object.model);
    if (is_new) at->second = reduce_occluder(object.model, triangles_);
    if (at->second.model == object.model) continue;
    object.shadow_model = at->second.model;
    object.shadow_displace = 2.0f * static_cast<float>(at->second.error);
  }
}

}  // namespace gnomon::pipeline
