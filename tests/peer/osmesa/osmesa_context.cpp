#include "peer/osmesa/osmesa_context.h"

#include <array>
#include <cstdlib>
#include <stdexcept>

#include <GL/osmesa.h>

namespace gnomon::peer {

namespace {

std::string gl_string(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "";
}

int gl_integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

}  // namespace

OsmesaContext::OsmesaContext(int width, int height)
    : width_(width),
      height_(height),
      color_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4) {
  const std::array<int, 9> attributes{OSMESA_FORMAT,
                                      OSMESA_RGBA,
                                      OSMESA_DEPTH_BITS,
                                      24,
                                      OSMESA_STENCIL_BITS,
                                      8,
                                      OSMESA_PROFILE,
                                      OSMESA_COMPAT_PROFILE,
                                      0};
  // Nothing is written to the home directory; on targets as small as the suite's llvmpipe's threads
  // cost more than they bring. What the user has set stays.
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
  if (width * height <= 128 * 128) setenv("LP_NUM_THREADS", "0", 0);
  context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (!context_) throw std::runtime_error("OSMesa gives no context");
  if (!OSMesaMakeCurrent(static_cast<OSMesaContext>(context_), color_.data(), GL_UNSIGNED_BYTE,
                         width, height)) {
    OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
    throw std::runtime_error("OSMesa does not make its context current");
  }
  renderer_ = gl_string(GL_RENDERER);
  version_ = gl_string(GL_VERSION);
  if (gl_integer(GL_DEPTH_BITS) != 24 || gl_integer(GL_STENCIL_BITS) != 8) {
    OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
    throw std::runtime_error("OSMesa gives no 24-bit depth with 8-bit stencil");
  }
}

OsmesaContext::~OsmesaContext() {
  OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
  OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
}

}  // namespace gnomon::peer
