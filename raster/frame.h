// A frame is data: passes of clears, draws and blits with their whole state and the buffers they go
// to. A method records a frame; execute (raster/execute.h) runs it. Nothing is drawn while
// recording. Borrowed memory (buffers, meshes, images) must outlive the frame's execution; keep()
// hands it to the frame instead.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>

#include "raster/buffers.h"
#include "raster/image_view.h"
#include "raster/mesh_view.h"
#include "raster/shading.h"
#include "raster/state.h"

namespace gnomon::raster {

/// The buffers a pass goes to, all of one size; an absent one is neither tested nor written.
struct Targets {
  ColorBuffer* color = nullptr;
  DepthBuffer* depth = nullptr;
  StencilBuffer* stencil = nullptr;
  bool operator==(const Targets&) const = default;

  /// The buffers' common size in pixels. Misuse: no buffer at all.
  int width() const;
  int height() const;
};

/// Sets what is named to a value, inside the scissor and under the masks (glClear).
struct Clear {
  std::optional<glm::vec4> color;
  /// In [0, 1]; clamped.
  std::optional<float> depth;
  /// The low 8 bits count.
  std::optional<int> stencil;
  std::array<bool, 4> color_write{true, true, true, true};
  bool depth_write = true;
  std::uint8_t stencil_write_mask = 0xff;
  std::optional<Rect> scissor;
};

/// Copies an image into the colour buffer with its bottom left pixel at (x, y): no test, no
/// blending. What falls outside the target is left out.
struct Blit {
  ImageView image;
  int x = 0, y = 0;
  std::array<bool, 4> color_write{true, true, true, true};
  std::optional<Rect> scissor;
};

/// Triangles with their whole state. Fragments pass scissor, stencil test, depth test, stencil
/// update, depth write, shading, blending and colour mask, in this order.
struct Draw {
  State state;
  MeshView mesh;
  glm::mat4 clip_from_model{1.0f};
  Shading shading = Flat{};
  StencilRef stencil_ref;
  /// For people: what is drawn, and the names of runs of the mesh's triangles, in order.
  std::string label = {};
  std::vector<MeshPart> parts = {};
};

using Command = std::variant<Clear, Draw, Blit>;

struct Pass {
  std::string label;
  Targets targets;
  std::vector<Command> commands;
};

class Frame {
 public:
  /// Commands that follow belong to this pass. Misuse: no target, or targets of different sizes.
  void begin_pass(std::string_view label, const Targets& targets);

  /// Records a command. Misuse: no pass was begun; a clear or blit of a target that the pass lacks;
  /// a draw whose attribute arrays or indices do not fit its positions, or whose parts begin out of
  /// order, inside a triangle or beyond the indices; lighting without normals,
  /// or at vertices with a shadow map; a lookup of the depth buffer that the draw goes to.
  void clear(const Clear& clear);
  void draw(Draw draw);
  void blit(const Blit& blit);

  /// Hands memory that commands borrow to the frame.
  void keep(std::shared_ptr<const void> owner) { kept_.push_back(std::move(owner)); }

  std::span<const Pass> passes() const { return passes_; }
  /// Commands of all passes together.
  std::size_t command_count() const;

 private:
  Pass& current();

  std::vector<Pass> passes_;
  std::vector<std::shared_ptr<const void>> kept_;
};

}  // namespace gnomon::raster
