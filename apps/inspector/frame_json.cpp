#include "apps/inspector/frame_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "apps/inspector/mesh_parts.h"
#include "raster/state_names.h"

namespace gnomon::apps::inspector {

using nlohmann::ordered_json;

namespace {

ordered_json number_or_null(float value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

std::string channels(const std::array<bool, 4>& write) {
  std::string out;
  for (std::size_t c = 0; c < 4; ++c)
    if (write[c]) out += "rgba"[c];
  return out;
}

ordered_json rect_json(const raster::Rect& rect) {
  return {rect.x, rect.y, rect.width, rect.height};
}

ordered_json face_json(const raster::StencilFace& face, int ref) {
  return {{"func", name(face.func)},     {"ref", std::clamp(ref, 0, 255)},
          {"read_mask", face.read_mask}, {"write_mask", face.write_mask},
          {"fail", name(face.fail)},     {"depth_fail", name(face.depth_fail)},
          {"pass", name(face.pass)}};
}

ordered_json blend_json(const raster::Blend& blend) {
  return {{"color", {name(blend.src_color), name(blend.dst_color), name(blend.color_op)}},
          {"alpha", {name(blend.src_alpha), name(blend.dst_alpha), name(blend.alpha_op)}}};
}

ordered_json state_json(const raster::Draw& draw) {
  const raster::State& state = draw.state;
  ordered_json out = ordered_json::object();
  if (state.depth)
    out["depth"] = {{"func", name(state.depth->func)}, {"write", state.depth->write}};
  if (state.stencil)
    out["stencil"] = {{"front", face_json(state.stencil->front, draw.stencil_ref.front)},
                      {"back", face_json(state.stencil->back, draw.stencil_ref.back)}};
  out["color_write"] = channels(state.color.write);
  if (state.color.blend) out["blend"] = blend_json(*state.color.blend);
  out["cull"] = name(state.cull);
  out["front_face"] = state.front_face == raster::FrontFace::ccw ? "ccw" : "cw";
  if (state.polygon_offset)
    out["polygon_offset"] = {number_or_null(state.polygon_offset->factor),
                             number_or_null(state.polygon_offset->units)};
  if (state.scissor) out["scissor"] = rect_json(*state.scissor);
  if (state.viewport) out["viewport"] = rect_json(*state.viewport);
  out["depth_range"] = {state.depth_range.near, state.depth_range.far};
  out["depth_clamp"] = state.depth_clamp;
  return out;
}

const char* shading_name(const raster::Draw& draw) {
  if (const auto* flat = std::get_if<raster::Flat>(&draw.shading))
    return flat->depth_lookup ? "flat, shadow map" : flat->texture ? "flat, texture" : "flat";
  const auto& lit = std::get<raster::Lit>(draw.shading);
  for (const raster::Light& light : lit.lights)
    if (light.shadow_map) return "lit, shadow map";
  return lit.at_vertices ? "lit at vertices" : "lit";
}

ordered_json fields(const raster::Draw& draw) {
  ordered_json parts = ordered_json::array();
  for (const raster::MeshPart& part : draw.parts)
    parts.push_back({{"label", part.label}, {"first_triangle", part.first_index / 3}});
  ordered_json out{{"label", draw.label},
                   {"triangles", draw.mesh.indices.size() / 3},
                   {"shading", shading_name(draw)},
                   {"state", state_json(draw)}};
  if (!parts.empty()) out["parts"] = parts;
  return out;
}

ordered_json fields(const raster::Clear& clear) {
  ordered_json out = ordered_json::object();
  if (clear.color) {
    out["color"] = ordered_json::array();
    for (int c = 0; c < 4; ++c) out["color"].push_back(number_or_null((*clear.color)[c]));
    out["color_write"] = channels(clear.color_write);
  }
  if (clear.depth) out["depth"] = number_or_null(*clear.depth);
  if (clear.depth && !clear.depth_write) out["depth_write"] = false;
  if (clear.stencil) {
    out["stencil"] = *clear.stencil & 255;
    out["stencil_write_mask"] = clear.stencil_write_mask;
  }
  if (clear.scissor) out["scissor"] = rect_json(*clear.scissor);
  return out;
}

ordered_json fields(const raster::Blit& blit) {
  ordered_json out{{"at", {blit.x, blit.y}}, {"size", {blit.image.width, blit.image.height}}};
  if (blit.scissor) out["scissor"] = rect_json(*blit.scissor);
  return out;
}

ordered_json command_json(const raster::Command& command) {
  ordered_json out{{"kind", kind(command)}};
  out.update(std::visit([](const auto& c) { return fields(c); }, command));
  return out;
}

template <class Buffer>
ordered_json buffer_json(const char* kind_name, const char* format, const Buffer& b) {
  return {{"kind", kind_name}, {"format", format}, {"width", b.width()}, {"height", b.height()}};
}
ordered_json buffer_json(const raster::ColorBuffer* b) {
  return buffer_json("color", b->format() == raster::ColorFormat::rgba8 ? "rgba8" : "rgba32f", *b);
}
ordered_json buffer_json(const raster::DepthBuffer* b) {
  return buffer_json("depth", b->format() == raster::DepthFormat::d24 ? "d24" : "d16", *b);
}
ordered_json buffer_json(const raster::StencilBuffer* b) {
  return buffer_json("stencil", "s8", *b);
}

ordered_json color_json(const raster::ColorBuffer& target, const glm::vec4& color) {
  ordered_json out = ordered_json::array();
  const bool whole = target.format() == raster::ColorFormat::rgba8;
  for (int c = 0; c < 4; ++c)
    out.push_back(whole ? ordered_json(std::lround(color[c] * 255.0f)) : number_or_null(color[c]));
  return out;
}

ordered_json values_json(const raster::Targets& targets, const raster::PixelValues& values) {
  ordered_json out = ordered_json::object();
  if (targets.color) out["color"] = color_json(*targets.color, values.color);
  if (targets.depth) out["depth"] = values.depth;
  if (targets.stencil) out["stencil"] = values.stencil;
  return out;
}

ordered_json fragment_json(const raster::Draw& draw, const raster::Targets& targets,
                           const raster::FragmentRecord& fragment) {
  ordered_json out{{"triangle", fragment.triangle}};
  const std::string_view part = part_of(draw, fragment.triangle);
  if (!part.empty()) out["part"] = part;
  out["facing"] = fragment.front_facing ? "front" : "back";
  out["depth"] = fragment.depth;
  out["outcome"] = raster::name(fragment.outcome);
  out["stencil_op"] = name(fragment.stencil_op);
  out["before"] = values_json(targets, fragment.before);
  out["after"] = values_json(targets, fragment.after);
  return out;
}

}  // namespace

Place place_of(const raster::Frame& frame, std::size_t command) {
  for (const raster::Pass& pass : frame.passes()) {
    if (command < pass.commands.size()) return {&pass, &pass.commands[command]};
    command -= pass.commands.size();
  }
  throw std::invalid_argument("a command is one of the frame's");
}

ordered_json frame_json(const raster::Frame& frame, const FrameBuffers& buffers, bool in_brief) {
  ordered_json passes = ordered_json::array(), list = ordered_json::array();
  for (std::size_t i = 0; i < buffers.size(); ++i)
    list.push_back(std::visit([](const auto* b) { return buffer_json(b); }, buffers[i]));
  for (const raster::Pass& pass : frame.passes()) {
    ordered_json commands = in_brief ? ordered_json(pass.commands.size()) : ordered_json::array();
    ordered_json targets = ordered_json::object();
    if (!in_brief)
      for (const raster::Command& command : pass.commands)
        commands.push_back(command_json(command));
    const auto add = [&](const char* name, const void* buffer) {
      if (const auto number = buffers.number_of(buffer)) targets[name] = *number;
    };
    add("color", pass.targets.color);
    add("depth", pass.targets.depth);
    add("stencil", pass.targets.stencil);
    passes.push_back({{"label", pass.label},
                      {"size", {pass.targets.width(), pass.targets.height()}},
                      {"targets", targets},
                      {"commands", commands}});
  }
  return {{"buffers", list}, {"passes", passes}};
}

ordered_json history_json(const raster::Frame& frame, const raster::PixelHistory& history) {
  ordered_json commands = ordered_json::array();
  for (const raster::CommandRecord& record : history.commands) {
    const raster::Command& command = *place_of(frame, record.command).command;
    const raster::Targets& targets = frame.passes()[record.pass].targets;
    ordered_json out{{"pass", record.pass},
                     {"command", record.command},
                     {"kind", kind(command)},
                     {"label", label(command)},
                     {"before", values_json(targets, record.before)},
                     {"after", values_json(targets, record.after)}};
    if (const auto* draw = std::get_if<raster::Draw>(&command)) {
      out["fragments"] = ordered_json::array();
      for (const raster::FragmentRecord& fragment : record.fragments)
        out["fragments"].push_back(fragment_json(*draw, targets, fragment));
    }
    commands.push_back(std::move(out));
  }
  return {{"x", history.x}, {"y", history.y}, {"commands", commands}};
}

}  // namespace gnomon::apps::inspector
