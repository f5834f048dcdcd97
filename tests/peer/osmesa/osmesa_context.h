// A real OpenGL to compare with: Mesa's software drivers without a window (OSMesa). RGBA8 colour,
// 24-bit depth, 8-bit stencil, compatibility profile, bottom row first. Which driver runs is
// Mesa's choice (llvmpipe) or GALLIUM_DRIVER's, taken once a process.
// Invariant: one context at a time is current, on the thread that made it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon::peer {

class OsmesaContext {
 public:
  /// Made current. Errors: std::runtime_error when Mesa gives no such context.
  OsmesaContext(int width, int height);
  ~OsmesaContext();
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  /// GL_RENDERER and GL_VERSION, for the record.
  const std::string& renderer() const { return renderer_; }
  const std::string& version() const { return version_; }
  bool is_llvmpipe() const { return renderer_.starts_with("llvmpipe"); }

 private:
  int width_, height_;
  /// What OSMesa draws into; outlives the context.
  std::vector<std::uint8_t> color_;
  void* context_ = nullptr;
  std::string renderer_, version_;
};

}  // namespace gnomon::peer
