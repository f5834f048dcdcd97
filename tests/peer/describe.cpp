#include "describe.h"

#include <sstream>
#include <string_view>

#include "raster/state_names.h"

namespace gnomon::peer {

using namespace gnomon::raster;

namespace {

class Writer {
 public:
  Writer() { out_.precision(9); }
  std::string text_so_far() const { return out_.str(); }

  void operator()(const Clear& clear) {
    out_ << "clear";
    if (clear.color) vector(" color", *clear.color);
    if (clear.depth) out_ << " depth " << *clear.depth;
    if (clear.stencil) out_ << " stencil " << *clear.stencil;
    color_mask(clear.color_write);
    if (!clear.depth_write) out_ << " depth_write off";
    if (clear.stencil_write_mask != 0xff)
      out_ << " stencil_write_mask " << int{clear.stencil_write_mask};
    rect(" scissor", clear.scissor);
    out_ << "\n";
  }

  void draw(const CaseDraw& draw, int width, int height) {
    out_ << "draw stencil_ref " << draw.stencil_ref.front << ' ' << draw.stencil_ref.back;
    vector(" color", draw.color);
    state(draw.state);
    if (draw.lookup) lookup(*draw.lookup, draw.depth_texture_mode);
    out_ << "\n";
    const Rect viewport = draw.state.viewport.value_or(Rect{0, 0, width, height});
    for (const Triangle& t : draw.triangles) triangle(t, viewport, draw.state.depth_range);
  }

 private:
  void vector(std::string_view name, const glm::vec4& v) {
    out_ << name << " (" << v.x << ", " << v.y << ", " << v.z << ", " << v.w << ")";
  }

  void rect(std::string_view name, const std::optional<Rect>& r) {
    if (r)
      out_ << name << " (" << r->x << ", " << r->y << ", " << r->width << ", " << r->height << ")";
  }

  void color_mask(const std::array<bool, 4>& write) {
    if (write == std::array<bool, 4>{true, true, true, true}) return;
    out_ << " color_write " << write[0] << write[1] << write[2] << write[3];
  }

  void face(std::string_view what, const StencilFace& f) {
    out_ << " stencil_" << what << " (func " << name(f.func) << ", read_mask " << int{f.read_mask}
         << ", write_mask " << int{f.write_mask} << ", fail " << name(f.fail) << ", depth_fail "
         << name(f.depth_fail) << ", pass " << name(f.pass) << ")";
  }

  void blend(const Blend& b) {
    out_ << " blend (" << name(b.color_op) << " " << name(b.src_color) << " " << name(b.dst_color)
         << ", alpha " << name(b.alpha_op) << " " << name(b.src_alpha) << " " << name(b.dst_alpha);
    vector(", constant", b.constant);
    out_ << ")";
  }

  void state(const State& s) {
    if (s.depth) out_ << " depth " << name(s.depth->func) << (s.depth->write ? "" : " unwritten");
    if (s.stencil) {
      face("front", s.stencil->front);
      face("back", s.stencil->back);
    }
    color_mask(s.color.write);
    if (s.color.blend) blend(*s.color.blend);
    if (s.cull != Cull::none) out_ << " cull " << name(s.cull);
    if (s.front_face != FrontFace::ccw) out_ << " front_face cw";
    if (s.polygon_offset)
      out_ << " polygon_offset (" << s.polygon_offset->factor << ", " << s.polygon_offset->units
           << ")";
    rect(" scissor", s.scissor);
    rect(" viewport", s.viewport);
    if (s.depth_range != DepthRange{})
      out_ << " depth_range (" << s.depth_range.near << ", " << s.depth_range.far << ")";
    if (s.depth_clamp) out_ << " depth_clamp";
  }

  void lookup(const DepthLookup& l, DepthTextureMode mode) {
    constexpr std::array<std::string_view, 3> kModes{"luminance", "alpha", "intensity"};
    out_ << " depth_lookup (" << name(l.func)
         << (l.filter == Filter::linear ? ", linear, " : ", nearest, ")
         << kModes.at(static_cast<std::size_t>(mode));
    if (l.border) out_ << ", border " << *l.border;
    for (int column = 0; column < 4; ++column) vector(", column", l.map_from_position[column]);
    out_ << ")";
  }

  void triangle(const Triangle& t, const Rect& v, const DepthRange& range) {
    out_ << "  triangle, window in 1/256 px and depth:";
    for (const glm::vec4& p : t) {
      const glm::dvec4 c(p);
      const double x = (c.x / c.w + 1.0) * 0.5 * v.width + v.x;
      const double y = (c.y / c.w + 1.0) * 0.5 * v.height + v.y;
      const double near = range.near, far = range.far;
      out_ << " (" << 256.0 * x << ", " << 256.0 * y << ", "
           << c.z / c.w * 0.5 * (far - near) + 0.5 * (far + near) << ")";
    }
    out_ << "; clip:";
    for (const glm::vec4& p : t) vector("", p);
    out_ << "\n";
  }

  std::ostringstream out_;
};

}  // namespace

std::string describe(const Case& described) {
  Writer writer;
  for (const CaseCommand& command : described.commands) {
    if (const Clear* clear = std::get_if<Clear>(&command))
      writer(*clear);
    else
      writer.draw(std::get<CaseDraw>(command), described.width, described.height);
  }
  std::ostringstream map;
  if (described.map.width > 0) {
    map << "map " << described.map.width << " x " << described.map.height << ":";
    for (const float depth : described.map.depths) map << " " << depth;
    map << "\n";
  }
  return map.str() + writer.text_so_far();
}

}  // namespace gnomon::peer
