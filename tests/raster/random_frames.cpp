#include "random_frames.h"

#include <array>
#include <cstring>

namespace gnomon::random_frames {

using namespace gnomon::raster;

namespace {

struct OwnedMesh {
  std::vector<glm::vec4> positions, colors;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> texcoords;
  std::vector<std::uint32_t> indices;
};

glm::vec3 random_vec3(Random& r, float low, float high) {
  const float x = r.real(low, high), y = r.real(low, high), z = r.real(low, high);
  return {x, y, z};
}

template <class E>
E random_enum(Random& r, E last) {
  return static_cast<E>(r.integer(0, static_cast<int>(last)));
}

/// A clip-space position; kinds follow what breaks rasterizers.
glm::vec4 random_position(Random& r, int width, int height) {
  switch (r.integer(0, 7)) {
    case 0: {  // on the sub-pixel grid, pixel centres and corners included
      const float x = static_cast<float>(r.integer(-8, 2 * width + 8)) / static_cast<float>(width);
      const float y =
          static_cast<float>(r.integer(-8, 2 * height + 8)) / static_cast<float>(height);
      return {x - 1.0f, y - 1.0f, r.real(-1.0f, 1.0f), 1.0f};
    }
    case 1:  // far outside: the guard band cuts
      return {random_vec3(r, -1e5f, 1e5f), r.real(0.01f, 1.0f)};
    case 2:  // behind the eye
      return {random_vec3(r, -2.0f, 2.0f), -r.real(0.0f, 2.0f)};
    case 3:  // at infinity
      return {random_vec3(r, -1.0f, 1.0f), 0.0f};
    case 4:  // on the far plane
      return {r.real(-1.0f, 1.0f), r.real(-1.0f, 1.0f), 1.0f, 1.0f};
    default: {
      const float w = r.real(0.1f, 4.0f);
      const float x = r.real(-1.3f, 1.3f), y = r.real(-1.3f, 1.3f), z = r.real(-1.2f, 1.2f);
      return {x * w, y * w, z * w, w};
    }
  }
}

std::shared_ptr<OwnedMesh> random_mesh(Random& r, int width, int height) {
  auto mesh = std::make_shared<OwnedMesh>();
  const int triangles = r.integer(1, 12);
  const bool tiny = r.chance(0.2f);
  for (int i = 0; i < triangles + 2; ++i) {
    glm::vec4 p = random_position(r, width, height);
    if (tiny && i > 0) {
      p = mesh->positions[0] + 0.02f * glm::vec4(random_vec3(r, -1.0f, 1.0f), 0.0f);
    }
    mesh->positions.push_back(p);
    mesh->normals.push_back(random_vec3(r, -1.0f, 1.0f));
    mesh->colors.push_back({random_vec3(r, 0.0f, 1.0f), r.real(0.0f, 1.0f)});
    mesh->texcoords.push_back({r.real(-2.0f, 2.0f), r.real(-2.0f, 2.0f)});
  }
  for (int i = 0; i < 3 * triangles; ++i)
    mesh->indices.push_back(static_cast<std::uint32_t>(r.integer(0, triangles + 1)));
  return mesh;
}

std::shared_ptr<const Texture> random_texture(Random& r) {
  auto texture = std::make_shared<Texture>();
  texture->width = r.integer(1, 5);
  texture->height = r.integer(1, 5);
  for (int i = 0; i < texture->width * texture->height; ++i) {
    Rgba8 c{};
    for (auto& channel : c) channel = static_cast<std::uint8_t>(r.integer(0, 255));
    texture->texels.push_back(c);
  }
  texture->wrap_s = random_enum(r, Wrap::mirrored_repeat);
  texture->wrap_t = random_enum(r, Wrap::mirrored_repeat);
  texture->filter = random_enum(r, Filter::linear);
  return texture;
}

raster::Light random_light(Random& r) {
  raster::Light light;
  light.position = {random_vec3(r, -3.0f, 3.0f), r.chance(0.5f) ? 1.0f : 0.0f};
  light.ambient = random_vec3(r, 0.0f, 0.2f);
  light.diffuse = random_vec3(r, 0.0f, 1.0f);
  light.specular = random_vec3(r, 0.0f, 1.0f);
  light.attenuation = random_vec3(r, 0.0f, 1.0f);
  if (r.chance(0.3f)) {
    light.spot_cos_cutoff = r.real(-0.5f, 0.9f);
    light.spot_exponent = r.integer(0, 5);
  }
  return light;
}

Shading random_shading(Random& r) {
  const std::shared_ptr<const Texture> texture = r.chance(0.4f) ? random_texture(r) : nullptr;
  if (r.chance(0.6f)) return Flat{{random_vec3(r, 0.0f, 1.0f), r.real(0.0f, 1.0f)}, texture};
  Lit lit;
  lit.material = {random_vec3(r, 0.0f, 1.0f), random_vec3(r, 0.0f, 1.0f),
                  random_vec3(r, 0.0f, 1.0f), random_vec3(r, 0.0f, 0.3f),
                  r.integer(0, 40),           r.real(0.0f, 1.0f)};
  for (int i = r.integer(0, 3); i > 0; --i) lit.lights.push_back(random_light(r));
  lit.scene_ambient = random_vec3(r, 0.0f, 0.5f);
  lit.ambient = r.chance(0.8f);
  lit.emission = r.chance(0.8f);
  lit.diffuse = r.chance(0.8f);
  lit.specular = r.chance(0.8f);
  lit.two_sided = r.chance(0.5f);
  lit.eye_world = random_vec3(r, -3.0f, 3.0f);
  lit.texture = texture;
  return lit;
}

StencilFace random_face(Random& r) {
  StencilFace face;
  face.func = random_enum(r, CompareFunc::always);
  if (r.chance(0.5f)) face.func = CompareFunc::always;
  face.read_mask = static_cast<std::uint8_t>(r.chance(0.5f) ? 255 : r.integer(0, 255));
  face.write_mask = static_cast<std::uint8_t>(r.chance(0.5f) ? 255 : r.integer(0, 255));
  face.fail = random_enum(r, StencilOp::invert);
  face.depth_fail = random_enum(r, StencilOp::invert);
  face.pass = random_enum(r, StencilOp::invert);
  return face;
}

Blend random_blend(Random& r) {
  Blend blend;
  blend.color_op = random_enum(r, BlendOp::max);
  blend.alpha_op = random_enum(r, BlendOp::max);
  blend.src_color = random_enum(r, BlendFactor::src_alpha_saturate);
  blend.dst_color = random_enum(r, BlendFactor::one_minus_constant_alpha);
  blend.src_alpha = random_enum(r, BlendFactor::src_alpha_saturate);
  blend.dst_alpha = random_enum(r, BlendFactor::one_minus_constant_alpha);
  blend.constant = {random_vec3(r, 0.0f, 1.0f), r.real(0.0f, 1.0f)};
  return blend;
}

Rect random_rect(Random& r, int width, int height) {
  const int x = r.integer(-5, width), y = r.integer(-5, height);
  return {x, y, r.integer(1, width + 8), r.integer(1, height + 8)};
}

std::array<bool, 4> random_write(Random& r) {
  if (r.chance(0.7f)) return {true, true, true, true};
  const bool red = r.chance(0.5f), green = r.chance(0.5f), blue = r.chance(0.5f);
  return {red, green, blue, r.chance(0.5f)};
}

Clear random_clear(Random& r, int width, int height) {
  Clear clear;
  if (r.chance(0.5f)) clear.color = glm::vec4{random_vec3(r, -0.1f, 1.1f), r.real(0.0f, 1.0f)};
  if (r.chance(0.5f)) clear.depth = r.real(-0.1f, 1.1f);
  if (r.chance(0.5f)) clear.stencil = r.integer(-3, 300);
  clear.color_write = random_write(r);
  clear.depth_write = r.chance(0.8f);
  clear.stencil_write_mask = static_cast<std::uint8_t>(r.chance(0.6f) ? 255 : r.integer(0, 255));
  if (r.chance(0.6f)) clear.scissor = random_rect(r, width, height);
  return clear;
}

template <class T>
void append(std::vector<std::uint8_t>& bytes, const T& value) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

}  // namespace

std::vector<std::uint8_t> Targets::bytes() const {
  std::vector<std::uint8_t> out;
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      if (color.format() == ColorFormat::rgba8)
        append(out, color.rgba8().at(x, y));
      else
        append(out, color.rgba32f().at(x, y));
      append(out, depth.at(x, y));
      append(out, stencil.at(x, y));
    }
  return out;
}

State random_state(Random& r, int width, int height) {
  State state;
  if (r.chance(0.7f)) state.depth = DepthState{random_enum(r, CompareFunc::always), r.chance(0.7f)};
  if (r.chance(0.7f)) state.stencil = StencilState{random_face(r), random_face(r)};
  state.color.write = random_write(r);
  if (r.chance(0.5f)) state.color.blend = random_blend(r);
  if (r.chance(0.3f)) state.cull = random_enum(r, Cull::front_and_back);
  state.front_face = random_enum(r, FrontFace::cw);
  if (r.chance(0.3f))
    state.polygon_offset = PolygonOffset{r.real(-2.0f, 2.0f), r.real(-9.0f, 9.0f)};
  if (r.chance(0.3f)) state.scissor = random_rect(r, width, height);
  if (r.chance(0.3f)) state.viewport = random_rect(r, width, height);
  if (r.chance(0.3f)) state.depth_range = {r.real(0.0f, 1.0f), r.real(0.0f, 1.0f)};
  if (r.chance(0.1f)) state.depth_range.far = state.depth_range.near;
  state.depth_clamp = r.chance(0.4f);
  return state;
}

void record_pass(Frame& frame, std::uint32_t seed, int commands, const raster::Targets& targets) {
  Random r(seed);
  const int width = targets.width(), height = targets.height();
  frame.begin_pass("random", targets);
  for (int i = 0; i < commands; ++i) {
    if (r.chance(0.1f)) {
      frame.clear(random_clear(r, width, height));
    } else if (r.chance(0.05f)) {
      auto pixels = std::make_shared<std::vector<std::uint8_t>>();
      const int w = r.integer(1, 20), h = r.integer(1, 20), channels = r.integer(3, 4);
      for (int k = 0; k < w * h * channels; ++k)
        pixels->push_back(static_cast<std::uint8_t>(r.integer(0, 255)));
      frame.keep(pixels);
      frame.blit({.image = ImageView::from_top_row(pixels->data(), w, h, channels),
                  .x = r.integer(-9, width),
                  .y = r.integer(-9, height),
                  .color_write = random_write(r)});
    } else {
      const std::shared_ptr<OwnedMesh> mesh = random_mesh(r, width, height);
      frame.keep(mesh);
      Draw draw;
      draw.state = random_state(r, width, height);
      draw.mesh = {mesh->positions, mesh->indices, mesh->normals, {}, mesh->texcoords};
      if (r.chance(0.4f)) draw.mesh.colors = mesh->colors;
      draw.shading = random_shading(r);
      const int ref = r.integer(-2, 260);
      draw.stencil_ref = {ref, 257 - ref};
      frame.draw(draw);
    }
  }
}

Frame random_frame(std::uint32_t seed, int commands, Targets& targets) {
  Frame frame;
  record_pass(frame, seed, commands, targets.all());
  return frame;
}

}  // namespace gnomon::random_frames
