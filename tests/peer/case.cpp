#include "case.h"

#include <memory>

#include "raster/execute.h"

namespace gnomon::peer {

using namespace gnomon::raster;

namespace {

struct OwnedMesh {
  std::vector<glm::vec4> positions;
  std::vector<std::uint32_t> indices;
};

std::shared_ptr<const OwnedMesh> mesh_of(const std::vector<Triangle>& triangles) {
  auto mesh = std::make_shared<OwnedMesh>();
  for (const Triangle& triangle : triangles)
    for (const glm::vec4& position : triangle) {
      mesh->indices.push_back(static_cast<std::uint32_t>(mesh->positions.size()));
      mesh->positions.push_back(position);
    }
  return mesh;
}

/// Calls body(x, y, i) for each pixel, i counting rows from the bottom one.
template <class Body>
void for_each_pixel(int width, int height, const Body& body) {
  std::size_t i = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) body(x, y, i++);
}

}  // namespace

std::size_t Case::draws() const {
  std::size_t count = 0;
  for (const CaseCommand& command : commands) count += std::holds_alternative<CaseDraw>(command);
  return count;
}

std::size_t Case::triangles() const {
  std::size_t count = 0;
  for (const CaseCommand& command : commands)
    if (const CaseDraw* draw = std::get_if<CaseDraw>(&command)) count += draw->triangles.size();
  return count;
}

Recording::Recording(const Case& recorded)
    : color_(recorded.width, recorded.height),
      depth_(recorded.width, recorded.height),
      stencil_(recorded.width, recorded.height) {
  if (recorded.map.width > 0) record_map(recorded.map);
  for (const CaseCommand& command : recorded.commands) {
    frame_.begin_pass("command", {&color_, &depth_, &stencil_});
    if (const Clear* clear = std::get_if<Clear>(&command))
      frame_.clear(*clear);
    else
      record(std::get<CaseDraw>(command));
  }
}

void Recording::record_map(const DepthMap& map) {
  map_.emplace(map.width, map.height);
  frame_.begin_pass("map", {nullptr, &*map_, nullptr});
  for_each_pixel(map.width, map.height, [&](int x, int y, std::size_t i) {
    frame_.clear({.depth = map.depths.at(i), .scissor = Rect{x, y, 1, 1}});
  });
  first_pass_ = 1;
  first_command_ = frame_.command_count();
  raster::execute(frame_, {.threads = 1});
}

const Pass& Recording::pass(std::size_t i) const { return frame_.passes()[first_pass_ + i]; }

void Recording::record(const CaseDraw& recorded) {
  const std::shared_ptr<const OwnedMesh> mesh = mesh_of(recorded.triangles);
  frame_.keep(mesh);
  Flat flat{.color = recorded.color,
            .depth_lookup = recorded.lookup,
            .depth_texture_mode = recorded.depth_texture_mode};
  if (flat.depth_lookup) flat.depth_lookup->map = map_ ? &*map_ : nullptr;
  frame_.draw({.state = recorded.state,
               .mesh = {.positions = mesh->positions, .indices = mesh->indices},
               .shading = flat,
               .stencil_ref = recorded.stencil_ref});
}

void Recording::execute(std::size_t first, std::size_t end) {
  raster::execute(
      frame_,
      {.threads = 1, .first_command = first_command_ + first, .commands = first_command_ + end});
}

Buffers Recording::read() const {
  return {stencil_.to_rows(), depth_.to_rows(), color_.to_rgba8_rows()};
}

void Recording::write(const Buffers& buffers) {
  for_each_pixel(width(), height(), [&](int x, int y, std::size_t i) {
    stencil_.plane().at(x, y) = buffers.stencil[i];
    depth_.plane().at(x, y) = buffers.depth[i];
    const std::uint8_t* c = buffers.color.data() + 4 * i;
    color_.rgba8().at(x, y) = {c[0], c[1], c[2], c[3]};
  });
}

}  // namespace gnomon::peer
