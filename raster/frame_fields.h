// The fields of a frame's commands in the order of the file, said once for both directions: `Io` is
// the writer of frame_encode.cpp or the reader of frame_decode.cpp, and every field is named for
// the reader's errors. Fields that a version has not got are left as they are.
// A change here changes the format: docs/frame-format.md and its version follow.
#pragma once

#include "raster/frame.h"

namespace gnomon::raster {

template <class Io>
void fields(Io& io, Rect& rect) {
  io.integer("a rectangle's x", rect.x);
  io.integer("a rectangle's y", rect.y);
  io.integer("a rectangle's width", rect.width);
  io.integer("a rectangle's height", rect.height);
}

template <class Io>
void fields(Io& io, DepthState& depth) {
  io.choice("a depth function", depth.func, CompareFunc::always);
  io.flag("a depth write flag", depth.write);
}

template <class Io>
void fields(Io& io, StencilFace& face) {
  io.choice("a stencil function", face.func, CompareFunc::always);
  io.byte("a stencil read mask", face.read_mask);
  io.byte("a stencil write mask", face.write_mask);
  io.choice("a stencil operation", face.fail, StencilOp::invert);
  io.choice("a stencil operation", face.depth_fail, StencilOp::invert);
  io.choice("a stencil operation", face.pass, StencilOp::invert);
}

template <class Io>
void fields(Io& io, StencilState& stencil) {
  fields(io, stencil.front);
  fields(io, stencil.back);
}

template <class Io>
void fields(Io& io, Blend& blend) {
  constexpr auto kLast = BlendFactor::src_alpha_saturate;
  io.choice("a blend operation", blend.color_op, BlendOp::max);
  io.choice("a blend operation", blend.alpha_op, BlendOp::max);
  io.choice("a blend factor", blend.src_color, kLast);
  io.choice("a blend factor", blend.dst_color, kLast);
  io.choice("a blend factor", blend.src_alpha, kLast);
  io.choice("a blend factor", blend.dst_alpha, kLast);
  io.floats("a blend constant", blend.constant);
}

template <class Io>
void fields(Io& io, PolygonOffset& offset) {
  io.real("a polygon offset's factor", offset.factor);
  io.real("a polygon offset's units", offset.units);
}

template <class Io>
void fields(Io& io, State& state) {
  io.optional("a depth state", state.depth);
  io.optional("a stencil state", state.stencil);
  io.mask("a colour mask", state.color.write);
  io.optional("a blend state", state.color.blend);
  io.choice("a cull mode", state.cull, Cull::front_and_back);
  io.choice("a front face", state.front_face, FrontFace::cw);
  io.optional("a polygon offset", state.polygon_offset);
  io.optional("a scissor", state.scissor);
  io.optional("a viewport", state.viewport);
  io.real("a depth range's near end", state.depth_range.near);
  io.real("a depth range's far end", state.depth_range.far);
  io.flag("a depth clamp flag", state.depth_clamp);
}

template <class Io>
void fields(Io& io, float& value) {
  io.real("a number", value);
}

template <class Io>
void fields(Io& io, int& value) {
  io.integer("a number", value);
}

template <class Io>
void fields(Io& io, glm::vec4& value) {
  io.floats("a colour", value);
}

template <class Io>
void fields(Io& io, DepthLookup& lookup) {
  io.map("a depth lookup's map", lookup.map);
  io.floats("a depth lookup's matrix", lookup.map_from_position);
  io.choice("a depth lookup's function", lookup.func, CompareFunc::always);
  io.choice("a depth lookup's filter", lookup.filter, Filter::linear);
  io.optional("a depth lookup's border", lookup.border);
}

template <class Io>
void fields(Io& io, Flat& flat) {
  io.floats("a flat colour", flat.color);
  io.texture("a texture", flat.texture);
  io.optional("a depth lookup", flat.depth_lookup);
  io.choice("a depth texture mode", flat.depth_texture_mode, DepthTextureMode::intensity);
}

template <class Io>
void fields(Io& io, Material& material) {
  io.floats("a material's ambient colour", material.ambient);
  io.floats("a material's diffuse colour", material.diffuse);
  io.floats("a material's specular colour", material.specular);
  io.floats("a material's emission", material.emission);
  io.integer("a specular exponent", material.shininess);
  io.real("a material's alpha", material.alpha);
}

template <class Io>
void fields(Io& io, Light& light) {
  io.floats("a light's position", light.position);
  io.floats("a light's ambient colour", light.ambient);
  io.floats("a light's diffuse colour", light.diffuse);
  io.floats("a light's specular colour", light.specular);
  io.floats("a light's attenuation", light.attenuation);
  io.floats("a spot's direction", light.spot_direction);
  io.real("a spot's cutoff", light.spot_cos_cutoff);
  io.integer("a spot's exponent", light.spot_exponent);
  io.optional("a shadow map", light.shadow_map);
}

template <class Io>
void fields(Io& io, Lit& lit) {
  fields(io, lit.material);
  io.list("the lights", lit.lights);
  io.floats("a scene's ambient colour", lit.scene_ambient);
  io.flag("the ambient flag", lit.ambient);
  io.flag("the emission flag", lit.emission);
  io.flag("the diffuse flag", lit.diffuse);
  io.flag("the specular flag", lit.specular);
  io.flag("the two-sided flag", lit.two_sided);
  if (io.version() >= 2) io.flag("the at-vertices flag", lit.at_vertices);
  io.floats("an eye position", lit.eye_world);
  io.floats("a world matrix", lit.world_from_model);
  io.floats("a normal matrix", lit.world_from_model_normal);
  io.texture("a texture", lit.texture);
}

template <class Io>
void fields(Io& io, MeshView& mesh) {
  io.array("the positions", mesh.positions);
  io.array("the indices", mesh.indices);
  io.array("the normals", mesh.normals);
  io.array("the colours", mesh.colors);
  io.array("the texture coordinates", mesh.texcoords);
}

template <class Io>
void fields(Io& io, MeshPart& part) {
  io.text("a part's label", part.label);
  io.word("a part's first index", part.first_index);
}

template <class Io>
void fields(Io& io, Clear& clear) {
  io.optional("a clear colour", clear.color);
  io.optional("a clear depth", clear.depth);
  io.optional("a clear stencil", clear.stencil);
  io.mask("a colour mask", clear.color_write);
  io.flag("a depth write flag", clear.depth_write);
  io.byte("a stencil write mask", clear.stencil_write_mask);
  io.optional("a scissor", clear.scissor);
}

template <class Io>
void fields(Io& io, Draw& draw) {
  io.text("a draw's label", draw.label);
  fields(io, draw.state);
  fields(io, draw.mesh);
  if (io.version() >= 3) io.list("the parts", draw.parts);
  io.floats("a clip matrix", draw.clip_from_model);
  io.integer("a front stencil reference", draw.stencil_ref.front);
  io.integer("a back stencil reference", draw.stencil_ref.back);
  io.alternative("a kind of shading", draw.shading);
}

template <class Io>
void fields(Io& io, Blit& blit) {
  io.picture("a picture", blit.image);
  io.integer("a blit's x", blit.x);
  io.integer("a blit's y", blit.y);
  io.mask("a colour mask", blit.color_write);
  io.optional("a scissor", blit.scissor);
}

template <class Io>
void fields(Io& io, Targets& targets) {
  io.target("a colour target", targets.color);
  io.target("a depth target", targets.depth);
  io.target("a stencil target", targets.stencil);
}

}  // namespace gnomon::raster
