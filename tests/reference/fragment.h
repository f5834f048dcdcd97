// What happens to one fragment, switch by switch (the second half of the reference renderer).
#pragma once

#include <cstdint>
#include <functional>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "raster/frame.h"

namespace gnomon::reference {

struct Sample {
  int x = 0, y = 0;
  std::uint32_t depth = 0;
  bool front_facing = true;
};

/// Where a fragment's way ended.
enum class Outcome : std::uint8_t { stencil_fail, depth_fail, pass };

/// Stencil test, depth test, stencil update, depth write, shading (only if it is seen), blending,
/// colour mask.
Outcome process_fragment(const raster::Draw& draw, const raster::Targets& targets,
                         const Sample& sample, const std::function<glm::vec4()>& color);

/// Attributes under perspective-correct weights of a mesh triangle's three vertices.
raster::Fragment interpolate(const raster::Draw& draw, const std::uint32_t* index,
                             const glm::vec3& weights, bool front_facing);

void clear_pixel(const raster::Clear& clear, const raster::Targets& targets, int x, int y);
void blit_pixel(const raster::Blit& blit, const raster::Targets& targets, int x, int y,
                const std::uint8_t* channels);

}  // namespace gnomon::reference
