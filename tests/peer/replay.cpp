#include "replay.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "raster/check.h"
#include "raster/kernels.h"

namespace gnomon::peer {

namespace {

using namespace gnomon::raster;

GLenum gl(CompareFunc func) {
  constexpr std::array<GLenum, 8> kFuncs{GL_NEVER,   GL_LESS,     GL_EQUAL,  GL_LEQUAL,
                                         GL_GREATER, GL_NOTEQUAL, GL_GEQUAL, GL_ALWAYS};
  return kFuncs.at(static_cast<std::size_t>(func));
}

GLenum gl(StencilOp op) {
  constexpr std::array<GLenum, 8> kOps{GL_KEEP,      GL_ZERO, GL_REPLACE,   GL_INCR,
                                       GL_INCR_WRAP, GL_DECR, GL_DECR_WRAP, GL_INVERT};
  return kOps.at(static_cast<std::size_t>(op));
}

GLenum gl(BlendOp op) {
  constexpr std::array<GLenum, 5> kOps{GL_FUNC_ADD, GL_FUNC_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT,
                                       GL_MIN, GL_MAX};
  return kOps.at(static_cast<std::size_t>(op));
}

GLenum gl(BlendFactor factor) {
  constexpr std::array<GLenum, 15> kFactors{GL_ZERO,
                                            GL_ONE,
                                            GL_SRC_COLOR,
                                            GL_ONE_MINUS_SRC_COLOR,
                                            GL_DST_COLOR,
                                            GL_ONE_MINUS_DST_COLOR,
                                            GL_SRC_ALPHA,
                                            GL_ONE_MINUS_SRC_ALPHA,
                                            GL_DST_ALPHA,
                                            GL_ONE_MINUS_DST_ALPHA,
                                            GL_CONSTANT_COLOR,
                                            GL_ONE_MINUS_CONSTANT_COLOR,
                                            GL_CONSTANT_ALPHA,
                                            GL_ONE_MINUS_CONSTANT_ALPHA,
                                            GL_SRC_ALPHA_SATURATE};
  return kFactors.at(static_cast<std::size_t>(factor));
}

GLint gl(Wrap wrap) {
  constexpr std::array<GLint, 3> kWraps{GL_REPEAT, GL_CLAMP_TO_EDGE, GL_MIRRORED_REPEAT};
  return kWraps.at(static_cast<std::size_t>(wrap));
}

GLint gl(DepthTextureMode mode) {
  constexpr std::array<GLint, 3> kModes{GL_LUMINANCE, GL_ALPHA, GL_INTENSITY};
  return kModes.at(static_cast<std::size_t>(mode));
}

void enable(GLenum what, bool on) { on ? glEnable(what) : glDisable(what); }

void set_scissor(const std::optional<Rect>& scissor) {
  enable(GL_SCISSOR_TEST, scissor.has_value());
  if (scissor) glScissor(scissor->x, scissor->y, scissor->width, scissor->height);
}

void set_color_mask(const std::array<bool, 4>& write) {
  glColorMask(write[0], write[1], write[2], write[3]);
}

void set_stencil(const std::optional<StencilState>& stencil, const StencilRef& ref) {
  enable(GL_STENCIL_TEST, stencil.has_value());
  if (!stencil) return;
  for (const bool front : {true, false}) {
    const StencilFace& face = front ? stencil->front : stencil->back;
    const GLenum which = front ? GL_FRONT : GL_BACK;
    glStencilFuncSeparate(which, gl(face.func), front ? ref.front : ref.back, face.read_mask);
    glStencilOpSeparate(which, gl(face.fail), gl(face.depth_fail), gl(face.pass));
    glStencilMaskSeparate(which, face.write_mask);
  }
}

void set_depth(const std::optional<DepthState>& depth) {
  enable(GL_DEPTH_TEST, depth.has_value());
  if (!depth) return;
  glDepthFunc(gl(depth->func));
  glDepthMask(depth->write);
}

void set_cull(Cull cull) {
  enable(GL_CULL_FACE, cull != Cull::none);
  if (cull == Cull::front) glCullFace(GL_FRONT);
  if (cull == Cull::back) glCullFace(GL_BACK);
  if (cull == Cull::front_and_back) glCullFace(GL_FRONT_AND_BACK);
}

void set_blend(const std::optional<Blend>& blend) {
  enable(GL_BLEND, blend.has_value());
  if (!blend) return;
  glBlendEquationSeparate(gl(blend->color_op), gl(blend->alpha_op));
  glBlendFuncSeparate(gl(blend->src_color), gl(blend->dst_color), gl(blend->src_alpha),
                      gl(blend->dst_alpha));
  glBlendColor(blend->constant.r, blend->constant.g, blend->constant.b, blend->constant.a);
}

void set_polygon_offset(const std::optional<PolygonOffset>& offset) {
  constexpr float kLlvmpipeUnitsAUnit = 0.5f;
  enable(GL_POLYGON_OFFSET_FILL, offset.has_value());
  if (offset) glPolygonOffset(offset->factor, offset->units * kLlvmpipeUnitsAUnit);
}

/// One command on a pass's targets.
class Replayer {
 public:
  Replayer(const OsmesaContext& context, const Targets& targets, bool color)
      : context_(context), targets_(targets), color_(color) {}

  void operator()(const Clear& clear) const {
    GLbitfield what = 0;
    set_scissor(clear.scissor);
    if (clear.color && color_) {
      what |= GL_COLOR_BUFFER_BIT;
      set_color_mask(clear.color_write);
      glClearColor(clear.color->r, clear.color->g, clear.color->b, clear.color->a);
    }
    if (clear.depth) {
      what |= GL_DEPTH_BUFFER_BIT;
      glDepthMask(clear.depth_write);
      glClearDepth(static_cast<double>(*clear.depth));
    }
    if (clear.stencil) {
      what |= GL_STENCIL_BUFFER_BIT;
      glStencilMask(clear.stencil_write_mask);
      glClearStencil(*clear.stencil);
    }
    if (what != 0) glClear(what);
  }

  void operator()(const Blit& blit) const {
    if (!color_) return;
    const ImageView& image = blit.image;
    std::vector<std::uint8_t> rows;
    rows.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                 4);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.pixel(x, y);
        rows.insert(rows.end(), {p[0], p[1], p[2], image.channels == 4 ? p[3] : std::uint8_t{0}});
      }
    for (const GLenum test : {GL_DEPTH_TEST, GL_STENCIL_TEST, GL_BLEND}) glDisable(test);
    set_scissor(blit.scissor);
    set_color_mask(blit.color_write);
    glViewport(0, 0, context_.width(), context_.height());
    glWindowPos2i(blit.x, blit.y);
    glDrawPixels(image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
  }

  void operator()(const Draw& draw) const {
    const State& state = draw.state;
    set_depth(targets_.depth ? state.depth : std::nullopt);
    set_stencil(targets_.stencil ? state.stencil : std::nullopt, draw.stencil_ref);
    set_color_mask(color_ ? state.color.write : ColorState::off().write);
    set_blend(state.color.blend);
    set_cull(state.cull);
    glFrontFace(state.front_face == FrontFace::ccw ? GL_CCW : GL_CW);
    set_polygon_offset(state.polygon_offset);
    set_scissor(state.scissor);
    const Rect viewport = state.viewport.value_or(Rect{0, 0, context_.width(), context_.height()});
    glViewport(viewport.x, viewport.y, viewport.width, viewport.height);
    glDepthRange(static_cast<double>(state.depth_range.near),
                 static_cast<double>(state.depth_range.far));
    enable(GL_DEPTH_CLAMP, state.depth_clamp);
    draw_triangles(draw);
  }

 private:
  static bool finite(const glm::vec4& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
  }

  /// The indices without triangles that have a position that is not finite: those draw nothing.
  static std::vector<std::uint32_t> drawable(const Draw& draw, const std::vector<glm::vec4>& clip) {
    std::vector<std::uint32_t> indices;
    indices.reserve(draw.mesh.indices.size());
    for (std::size_t i = 0; i + 2 < draw.mesh.indices.size(); i += 3) {
      const auto triangle = draw.mesh.indices.subspan(i, 3);
      if (finite(clip[triangle[0]]) && finite(clip[triangle[1]]) && finite(clip[triangle[2]]))
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    }
    return indices;
  }

  static void set_texture(const Texture& texture, const MeshView& mesh) {
    const GLint filter = texture.filter == Filter::linear ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, gl(texture.wrap_s));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, gl(texture.wrap_t));
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, texture.width, texture.height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, texture.texels.data());
    glEnable(GL_TEXTURE_2D);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glTexCoordPointer(2, GL_FLOAT, sizeof(glm::vec2), mesh.texcoords.data());
  }

  /// On texture unit 1, so that a colour texture may be there too.
  static void set_depth_lookup(const Flat& flat, const std::vector<glm::vec4>& coordinates) {
    const DepthLookup& lookup = *flat.depth_lookup;
    glActiveTexture(GL_TEXTURE1);
    const GLint filter = lookup.filter == Filter::linear ? GL_LINEAR : GL_NEAREST;
    const GLint wrap = lookup.border ? GL_CLAMP_TO_BORDER : GL_CLAMP_TO_EDGE;
    const std::array<GLfloat, 4> border{lookup.border.value_or(0.0f), 0.0f, 0.0f, 0.0f};
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, border.data());
    for (const auto& [name, value] :
         {std::pair{GL_TEXTURE_MIN_FILTER, filter}, std::pair{GL_TEXTURE_MAG_FILTER, filter},
          std::pair{GL_TEXTURE_WRAP_S, wrap}, std::pair{GL_TEXTURE_WRAP_T, wrap},
          std::pair{GL_TEXTURE_COMPARE_MODE, GL_COMPARE_R_TO_TEXTURE},
          std::pair{GL_TEXTURE_COMPARE_FUNC, static_cast<GLint>(gl(lookup.func))},
          std::pair{GL_DEPTH_TEXTURE_MODE, gl(flat.depth_texture_mode)}})
      glTexParameteri(GL_TEXTURE_2D, static_cast<GLenum>(name), value);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    std::vector<std::uint32_t> texels = lookup.map->to_rows();
    for (std::uint32_t& texel : texels) texel = texel << 8 | texel >> 16;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, lookup.map->width(), lookup.map->height(),
                 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, texels.data());
    glEnable(GL_TEXTURE_2D);
    glClientActiveTexture(GL_TEXTURE1);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glTexCoordPointer(4, GL_FLOAT, sizeof(glm::vec4), coordinates.data());
  }

  static void end_depth_lookup() {
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    glClientActiveTexture(GL_TEXTURE0);
    glDisable(GL_TEXTURE_2D);
    glActiveTexture(GL_TEXTURE0);
  }

  void draw_triangles(const Draw& draw) const {
    std::vector<glm::vec4> clip(draw.mesh.positions.size());
    scalar_kernels().transform(draw.clip_from_model, draw.mesh.positions.data(), clip.size(),
                               clip.data());
    const std::vector<std::uint32_t> indices = drawable(draw, clip);
    std::vector<glm::vec4> colors(clip.size(), glm::vec4(1.0f));
    const Flat* flat = std::get_if<Flat>(&draw.shading);
    if (flat) {
      for (std::size_t i = 0; i < colors.size(); ++i)
        colors[i] = draw.mesh.colors.empty() ? flat->color : flat->color * draw.mesh.colors[i];
    }
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(4, GL_FLOAT, sizeof(glm::vec4), clip.data());
    glEnableClientState(GL_COLOR_ARRAY);
    glColorPointer(4, GL_FLOAT, sizeof(glm::vec4), colors.data());
    if (flat && flat->texture) set_texture(*flat->texture, draw.mesh);
    std::vector<glm::vec4> map_coordinates(clip.size());
    const bool looks_up = flat && flat->depth_lookup;
    if (looks_up) {
      scalar_kernels().transform(flat->depth_lookup->map_from_position, draw.mesh.positions.data(),
                                 clip.size(), map_coordinates.data());
      set_depth_lookup(*flat, map_coordinates);
    }
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices.size()), GL_UNSIGNED_INT,
                   indices.data());
    if (looks_up) end_depth_lookup();
    glDisable(GL_TEXTURE_2D);
    for (const GLenum array : {GL_VERTEX_ARRAY, GL_COLOR_ARRAY, GL_TEXTURE_COORD_ARRAY})
      glDisableClientState(array);
  }

  const OsmesaContext& context_;
  const Targets targets_;
  const bool color_;
};

void check_errors(const std::string& pass) {
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw std::runtime_error("OpenGL error " + std::to_string(error) + " in pass '" + pass + "'");
}

}  // namespace

void reset(const OsmesaContext& context) {
  const Replayer replayer(context, {}, true);
  replayer(Clear{.color = glm::vec4(0.0f), .depth = 1.0f, .stencil = 0});
  check_errors("reset");
}

void replay(const OsmesaContext& context, const raster::Pass& pass,
            const raster::ColorBuffer* color) {
  require(!pass.targets.depth || pass.targets.depth->format() == DepthFormat::d24,
          "a replayed pass has 24-bit depth");
  for (const GLenum mode : {GL_PROJECTION, GL_MODELVIEW}) {
    glMatrixMode(mode);
    glLoadIdentity();
  }
  glDisable(GL_DITHER);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const bool draws_color = color && pass.targets.color == color;
  const Replayer replayer(context, pass.targets, draws_color);
  for (const Command& command : pass.commands) std::visit(replayer, command);
  check_errors(pass.label);
}

Buffers read_back(const OsmesaContext& context) {
  const std::size_t pixels =
      static_cast<std::size_t>(context.width()) * static_cast<std::size_t>(context.height());
  std::vector<std::uint32_t> packed(pixels);
  Buffers out;
  out.color.resize(4 * pixels);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, context.width(), context.height(), GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
               packed.data());
  glReadPixels(0, 0, context.width(), context.height(), GL_RGBA, GL_UNSIGNED_BYTE,
               out.color.data());
  check_errors("read back");
  out.stencil.reserve(pixels);
  out.depth.reserve(pixels);
  for (const std::uint32_t value : packed) {
    out.stencil.push_back(static_cast<std::uint8_t>(value & 0xffu));
    out.depth.push_back(value >> 8);
  }
  return out;
}

}  // namespace gnomon::peer
