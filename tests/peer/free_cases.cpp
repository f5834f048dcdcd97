#include "cases.h"
#include "random_frames.h"

namespace gnomon::peer {

using namespace gnomon::raster;
using random_frames::Random;

namespace {

constexpr int kStates = 4, kDraws = 40;

glm::vec4 random_color(Random& random) {
  glm::vec4 color;
  for (int c = 0; c < 4; ++c) color[c] = static_cast<float>(random.integer(0, 255)) / 255.0f;
  return color;
}

/// In front of the eye, mostly inside the view volume.
glm::vec4 ordinary_position(Random& random) {
  const float w = random.real(0.1f, 4.0f);
  const float x = random.real(-1.4f, 1.4f), y = random.real(-1.4f, 1.4f);
  return {x * w, y * w, random.real(-1.1f, 1.1f) * w, w};
}

/// Of the kinds that break rasterizers: far outside, behind the eye, at infinity, on the far plane.
glm::vec4 extreme_position(Random& random) {
  const auto real = [&](float reach) { return random.real(-reach, reach); };
  const float x = real(1.0f), y = real(1.0f), z = real(1.0f);
  switch (random.integer(0, 4)) {
    case 0:
      return {100.0f * x, 100.0f * y, z, random.real(0.5f, 1.0f)};
    case 1:
      return {1e5f * x, 1e5f * y, 1e5f * z, random.real(0.01f, 1.0f)};
    case 2:
      return {2.0f * x, 2.0f * y, 2.0f * z, -random.real(0.0f, 2.0f)};
    case 3:
      return {x, y, z, 0.0f};
    default:
      return {x, y, 1.0f, 1.0f};
  }
}

Triangle random_triangle(Random& random) {
  Triangle triangle;
  for (glm::vec4& position : triangle)
    position = random.chance(0.85f) ? ordinary_position(random) : extreme_position(random);
  const auto near = [&](const glm::vec4& p, float reach) {
    glm::vec4 q = p;
    for (int axis = 0; axis < 3; ++axis) q[axis] += random.real(-reach, reach);
    return q;
  };
  switch (random.integer(0, 7)) {
    case 0:  // of some pixels, of less than one
      triangle[1] = near(triangle[0], 0.1f);
      triangle[2] = near(triangle[0], 0.1f);
      break;
    case 1:
      triangle[1] = near(triangle[0], 0.02f);
      triangle[2] = near(triangle[0], 0.02f);
      break;
    case 2:  // a sliver with a short side, a sliver with an obtuse corner
      triangle[1] = near(triangle[0], 0.02f);
      break;
    case 3:
      triangle[2] = near(0.5f * (triangle[0] + triangle[1]), 0.02f);
      break;
    default:
      break;
  }
  return triangle;
}

Rect random_rect(Random& random) {
  const int x = random.integer(-5, kCaseSize - 8), y = random.integer(-5, kCaseSize - 8);
  return {x, y, random.integer(8, kCaseSize + 8), random.integer(8, kCaseSize + 8)};
}

State random_pipeline(Random& random) {
  State state = random_frames::random_state(random, kCaseSize, kCaseSize);
  if (state.color.blend) state.color.blend->constant = random_color(random);
  return state;
}

CaseDraw random_draw(Random& random, const State& pipeline) {
  CaseDraw draw;
  draw.state = pipeline;
  draw.state.scissor.reset();
  draw.state.viewport.reset();
  if (random.chance(0.3f)) draw.state.scissor = random_rect(random);
  if (random.chance(0.3f)) draw.state.viewport = random_rect(random);
  const int ref = random.integer(-2, 260);
  draw.stencil_ref = {ref, 257 - ref};
  draw.color = random_color(random);
  for (int count = random.integer(1, 4); count > 0; --count)
    draw.triangles.push_back(random_triangle(random));
  return draw;
}

}  // namespace

Case free_case(std::uint32_t seed) {
  Random random(seed);
  Case out{.width = kCaseSize, .height = kCaseSize};
  out.commands.emplace_back(Clear{.color = random_color(random),
                                  .depth = random.chance(0.5f) ? 1.0f : random.real(0.0f, 1.0f),
                                  .stencil = random.integer(0, 255)});
  std::vector<State> states;
  for (int i = 0; i < kStates; ++i) states.push_back(random_pipeline(random));
  for (int d = 0; d < kDraws; ++d)
    out.commands.emplace_back(
        random_draw(random, states[static_cast<std::size_t>(random.integer(0, kStates - 1))]));
  return out;
}

}  // namespace gnomon::peer
