#include "pipeline/full_screen.h"

#include <array>
#include <bit>
#include <string>
#include <utility>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

struct Quad {
  std::array<glm::vec4, 4> positions{
      glm::vec4{-1.0f, -1.0f, 1.0f, 1.0f}, glm::vec4{1.0f, -1.0f, 1.0f, 1.0f},
      glm::vec4{1.0f, 1.0f, 1.0f, 1.0f}, glm::vec4{-1.0f, 1.0f, 1.0f, 1.0f}};
  std::array<glm::vec2, 4> texcoords{glm::vec2{0.0f, 0.0f}, glm::vec2{1.0f, 0.0f},
                                     glm::vec2{1.0f, 1.0f}, glm::vec2{0.0f, 1.0f}};
  std::array<std::uint32_t, 6> indices{0, 1, 2, 0, 2, 3};
};

void stencil_quad(raster::Frame& frame, const raster::StencilFace& face, int ref,
                  std::string label) {
  raster::Draw draw = full_screen_quad(frame, std::move(label));
  draw.state.color = raster::ColorState::off();
  draw.state.stencil = raster::StencilState::both(face);
  draw.stencil_ref = ref;
  frame.draw(std::move(draw));
}

}  // namespace

raster::Draw full_screen_quad(raster::Frame& frame, std::string label) {
  const auto quad = std::make_shared<const Quad>();
  frame.keep(quad);
  raster::Draw draw;
  draw.mesh = {.positions = quad->positions, .indices = quad->indices};
  draw.label = std::move(label);
  return draw;
}

raster::DepthState where_a_surface_is() {
  return {.func = raster::CompareFunc::greater, .write = false};
}

void flag_counts(raster::Frame& frame) { flag_counts(frame, 0x7f, 0xff); }

void flag_counts(raster::Frame& frame, std::uint8_t counts, std::uint8_t bits) {
  stencil_quad(frame,
               {.func = raster::CompareFunc::not_equal,
                .read_mask = counts,
                .write_mask = bits,
                .pass = raster::StencilOp::replace},
               std::bit_floor(bits),
               "counts become bit " + std::to_string(std::bit_width(bits) - 1));
}

void drop_flagged(raster::Frame& frame) {
  stencil_quad(
      frame,
      {.func = raster::CompareFunc::equal, .read_mask = kCounted, .pass = raster::StencilOp::zero},
      kCounted, "zero where bit 7 is set");
}

std::shared_ptr<const raster::Texture> photograph_texture(const raster::ImageView& photograph) {
  raster::require(photograph.data != nullptr && photograph.width > 0 && photograph.height > 0 &&
                      (photograph.channels == 3 || photograph.channels == 4),
                  "a photograph has pixels of 3 or 4 channels");
  auto texture = std::make_shared<raster::Texture>();
  texture->width = photograph.width;
  texture->height = photograph.height;
  texture->wrap_s = texture->wrap_t = raster::Wrap::clamp_to_edge;
  texture->filter = raster::Filter::nearest;
  texture->texels.reserve(static_cast<std::size_t>(photograph.width) *
                          static_cast<std::size_t>(photograph.height));
  for (int y = 0; y < photograph.height; ++y) {
    for (int x = 0; x < photograph.width; ++x) {
      const std::uint8_t* pixel = photograph.pixel(x, y);
      texture->texels.push_back({pixel[0], pixel[1], pixel[2], 255});
    }
  }
  return texture;
}

raster::Draw photograph_quad(raster::Frame& frame, std::shared_ptr<const raster::Texture> texture,
                             float factor, std::string label) {
  const auto quad = std::make_shared<const Quad>();
  frame.keep(quad);
  raster::Draw draw;
  draw.mesh = {
      .positions = quad->positions, .indices = quad->indices, .texcoords = quad->texcoords};
  draw.shading = raster::Flat{glm::vec4(factor, factor, factor, 1.0f), std::move(texture)};
  draw.label = std::move(label);
  return draw;
}

}  // namespace gnomon::pipeline
