#include "bench/layer.h"

#include <random>

namespace gnomon::bench {
namespace {

pipeline::Mesh screen(float z_below, float z_above) {
  pipeline::Mesh mesh;
  mesh.positions = {{-1.0f, -1.0f, z_below, 1.0f},
                    {1.0f, -1.0f, z_below, 1.0f},
                    {1.0f, 1.0f, z_above, 1.0f},
                    {-1.0f, 1.0f, z_above, 1.0f}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

}  // namespace

pipeline::Mesh leaning_plane() { return screen(-0.8f, -0.4f); }

pipeline::Mesh layer() { return screen(0.0f, 0.0f); }

std::vector<std::uint32_t> random_depths(int width, int height) {
  std::mt19937 random(7);
  std::vector<std::uint32_t> depths(static_cast<std::size_t>(width) *
                                    static_cast<std::size_t>(height));
  for (std::uint32_t& depth : depths) depth = static_cast<std::uint32_t>(random()) >> 8;
  return depths;
}

}  // namespace gnomon::bench
