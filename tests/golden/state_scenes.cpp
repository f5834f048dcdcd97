// Scenes of the rarer fixed-function states: two-sided saturating stencil, masked and scissored
// clears, depth clamp, polygon offset, depth ranges.
#include <memory>

#include "golden/scenes.h"
#include "raster/random_frames.h"

namespace gnomon::golden {
namespace {

using raster::CompareFunc;
using raster::StencilOp;

/// Triangles without an index in common.
struct Triangles {
  std::vector<glm::vec4> positions;
  std::vector<std::uint32_t> indices;

  void add(const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) {
    for (const glm::vec4& p : {a, b, c}) {
      indices.push_back(static_cast<std::uint32_t>(positions.size()));
      positions.push_back(p);
    }
  }
  raster::MeshView view() const { return {positions, indices}; }
};

/// Covers the target.
Triangles everything() {
  Triangles out;
  out.add({-1.0f, -1.0f, 0.0f, 1.0f}, {3.0f, -1.0f, 0.0f, 1.0f}, {-1.0f, 3.0f, 0.0f, 1.0f});
  return out;
}

/// Overlapping triangles of both facings and of any slope in depth.
Triangles scattered(random_frames::Random& r, int count, float z_low, float z_high) {
  Triangles out;
  const auto corner = [&](float x, float y) {
    const float w = r.real(0.5f, 2.0f), dx = r.real(-0.6f, 0.6f), dy = r.real(-0.6f, 0.6f);
    return glm::vec4((x + dx) * w, (y + dy) * w, r.real(z_low, z_high) * w, w);
  };
  for (int i = 0; i < count; ++i) {
    const float x = r.real(-0.8f, 0.8f), y = r.real(-0.8f, 0.8f);
    const glm::vec4 a = corner(x, y), b = corner(x, y), c = corner(x, y);
    out.add(a, b, c);
  }
  return out;
}

/// One colour for the pixels whose stencil value compares so with the reference.
raster::Draw paint(const Triangles& on, CompareFunc func, int reference, const glm::vec4& color) {
  return {.state = {.stencil = raster::StencilState::both({.func = func})},
          .mesh = on.view(),
          .shading = raster::Flat{.color = color},
          .stencil_ref = reference};
}

/// Counts from both ends of the byte: near 255 front faces saturate and back faces wrap, near 0 the
/// other way round; masks and scissors cut what is cleared and what is counted.
raster::RecordedFrame record_saturation() {
  struct Kept {
    Triangles all = everything(), scattered;
  };
  raster::RecordedFrame out;
  const raster::Targets targets = add_targets(out, {160, 120}, {});
  random_frames::Random r(5);
  auto kept = std::make_shared<Kept>();
  kept->scattered = scattered(r, 40, -0.9f, 0.9f);
  out.frame.keep(kept);
  raster::Frame& frame = out.frame;

  frame.begin_pass("masked clears", targets);
  frame.clear({.color = glm::vec4(0.2f, 0.4f, 0.6f, 0.8f), .depth = 0.6f, .stencil = 3});
  frame.clear({.stencil = 253, .scissor = raster::Rect{80, -5, 200, 300}});
  frame.clear({.color = glm::vec4(1.0f, 0.9f, 0.8f, 0.7f),
               .depth = 0.4f,
               .stencil = 0xc3,
               .color_write = {true, false, true, false},
               .stencil_write_mask = 0x3c,
               .scissor = raster::Rect{40, 30, 80, 60}});
  frame.clear({.color = glm::vec4(0.0f),
               .depth = 0.0f,
               .color_write = {false, false, false, true},
               .depth_write = false,
               .scissor = raster::Rect{0, 0, 20, 120}});

  frame.begin_pass("counts that saturate and wrap", targets);
  frame.draw({.state = {.depth = raster::DepthState{CompareFunc::less, false},
                        .stencil =
                            raster::StencilState{
                                {.depth_fail = StencilOp::decr_wrap, .pass = StencilOp::incr},
                                {.depth_fail = StencilOp::incr_wrap, .pass = StencilOp::decr}},
                        .color = raster::ColorState::off()},
              .mesh = kept->scattered.view(),
              .label = "saturating where the depth test passes"});
  frame.draw({.state = {.stencil = raster::StencilState{{.func = CompareFunc::not_equal,
                                                         .read_mask = 0x0f,
                                                         .write_mask = 0x5a,
                                                         .fail = StencilOp::invert,
                                                         .pass = StencilOp::replace},
                                                        {.func = CompareFunc::less,
                                                         .write_mask = 0xf0,
                                                         .fail = StencilOp::incr,
                                                         .pass = StencilOp::keep}},
                        .color = raster::ColorState::off(),
                        .front_face = raster::FrontFace::cw,
                        .scissor = raster::Rect{100, 60, 50, 70}},
              .mesh = kept->scattered.view(),
              .stencil_ref = 300,
              .label = "masks and a reference beyond 255"});

  frame.begin_pass("counts as colours", targets);
  frame.draw(paint(kept->all, CompareFunc::equal, 255, {1.0f, 0.0f, 0.0f, 1.0f}));
  frame.draw(paint(kept->all, CompareFunc::equal, 0, {0.0f, 1.0f, 0.0f, 1.0f}));
  frame.draw(paint(kept->all, CompareFunc::greater, 4, {0.0f, 0.0f, 1.0f, 0.5f}));
  return out;
}

/// Depth beyond both planes clamped to four ranges, one of them reversed and one of no width, in
/// the four quarters of the target; then decals on the same geometry by offset and by equality.
raster::RecordedFrame record_depth_clamp(raster::DepthFormat format) {
  raster::RecordedFrame out;
  const raster::Targets targets = add_targets(out, {130, 97}, {.depth = format});
  random_frames::Random r(6);
  auto kept = std::make_shared<const Triangles>(scattered(r, 30, -1.6f, 1.6f));
  out.frame.keep(kept);
  raster::Frame& frame = out.frame;
  frame.begin_pass("depth clamp and offset", targets);
  frame.clear({.color = glm::vec4(0.5f), .depth = 1.0f, .stencil = 0});
  const raster::DepthRange ranges[] = {{0.0f, 1.0f}, {0.25f, 0.75f}, {0.9f, 0.2f}, {0.5f, 0.5f}};
  for (int i = 0; i < 4; ++i) {
    const raster::Rect quarter{65 * (i % 2), 49 * (i / 2), 65, 49};
    const auto draw = [&](CompareFunc func, raster::PolygonOffset offset, const glm::vec4& color,
                          raster::Cull cull) {
      frame.draw({.state = {.depth = raster::DepthState{.func = func},
                            .stencil = raster::StencilState::both(
                                {.depth_fail = StencilOp::incr, .pass = StencilOp::incr_wrap}),
                            .cull = cull,
                            .polygon_offset = offset,
                            .scissor = quarter,
                            .depth_range = ranges[i],
                            .depth_clamp = true},
                  .mesh = kept->view(),
                  .shading = raster::Flat{.color = color}});
    };
    draw(CompareFunc::less, {0.0f, 0.0f}, {0.8f, 0.2f, 0.1f, 1.0f}, raster::Cull::none);
    draw(CompareFunc::equal, {0.0f, 0.0f}, {0.1f, 0.7f, 0.2f, 1.0f}, raster::Cull::back);
    draw(CompareFunc::less_equal, {-1.5f, -3.0f}, {0.2f, 0.3f, 0.9f, 1.0f}, raster::Cull::front);
    draw(CompareFunc::greater, {2.0f, 7.0f}, {0.9f, 0.9f, 0.2f, 1.0f}, raster::Cull::back);
  }
  return out;
}

}  // namespace

void add_state_scenes(std::vector<Scene>& all) {
  all.push_back({.name = "state-stencil-saturation", .record = record_saturation, .quick = true});
  for (const auto& [name, format] : {std::pair{"state-depth-clamp", raster::DepthFormat::d24},
                                     {"state-depth-clamp-d16", raster::DepthFormat::d16}})
    all.push_back(
        {.name = name, .record = [format] { return record_depth_clamp(format); }, .quick = true});
}

}  // namespace gnomon::golden
