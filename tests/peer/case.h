// A trial for two rasterizers as plain values: commands that own their triangles, so that one can
// be taken away, moved or set to a default and what is left is still a trial. A Recording turns it
// into a frame (raster/frame.h) with buffers of its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include <glm/vec4.hpp>

#include "raster/frame.h"
#include "replay.h"

namespace gnomon::peer {

/// Clip coordinates.
using Triangle = std::array<glm::vec4, 3>;

struct CaseDraw {
  raster::State state;
  raster::StencilRef stencil_ref;
  glm::vec4 color{1.0f};
  /// Its map is the case's.
  std::optional<raster::DepthLookup> lookup;
  raster::DepthTextureMode depth_texture_mode = raster::DepthTextureMode::luminance;
  std::vector<Triangle> triangles;
};

using CaseCommand = std::variant<raster::Clear, CaseDraw>;

/// A depth buffer to look up: depths in [0, 1], row after row from the bottom.
struct DepthMap {
  int width = 0, height = 0;
  std::vector<float> depths;
};

struct Case {
  int width = 0, height = 0;
  DepthMap map;
  std::vector<CaseCommand> commands;

  std::size_t draws() const;
  std::size_t triangles() const;
};

/// The case as a frame of a pass a command, and the buffers it goes to: RGBA8, D24 and stencil,
/// at their initial values. A map has a pass of its own before them, a clear a texel, which has
/// been executed.
class Recording {
 public:
  explicit Recording(const Case& recorded);
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  const raster::Frame& frame() const { return frame_; }
  /// The pass of the case's command i.
  const raster::Pass& pass(std::size_t i) const;
  const raster::ColorBuffer& color() const { return color_; }
  int width() const { return color_.width(); }
  int height() const { return color_.height(); }

  /// Runs the case's commands [first, end) on gnomon.
  void execute(std::size_t first, std::size_t end);
  Buffers read() const;
  /// The three targets now hold these bytes.
  void write(const Buffers& buffers);

 private:
  void record_map(const DepthMap& map);
  void record(const CaseDraw& draw);

  raster::ColorBuffer color_;
  raster::DepthBuffer depth_;
  raster::StencilBuffer stencil_;
  std::optional<raster::DepthBuffer> map_;
  raster::Frame frame_;
  /// Of the map.
  std::size_t first_pass_ = 0, first_command_ = 0;
};

}  // namespace gnomon::peer
