// The buffers that a frame draws to or looks up, numbered in the order in which it mentions them
// first, as the frame format numbers them.
#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "raster/frame.h"
#include "raster/frame_format.h"

namespace gnomon::apps::inspector {

using BufferPointer =
    std::variant<raster::ColorBuffer*, raster::DepthBuffer*, raster::StencilBuffer*>;

class FrameBuffers {
 public:
  explicit FrameBuffers(const raster::Frame& frame);

  std::size_t size() const { return buffers_.size(); }
  const BufferPointer& operator[](std::size_t number) const { return buffers_[number]; }
  /// Nothing for null.
  std::optional<std::size_t> number_of(const void* buffer) const;

  /// What a copy of their pixels takes.
  std::size_t bytes() const;
  /// What they hold, and back.
  std::vector<raster::Buffer> save() const;
  void restore(const std::vector<raster::Buffer>& saved) const;
  /// As they are constructed.
  void reset() const;

 private:
  template <class Buffer>
  void add_new(Buffer* buffer);

  std::vector<BufferPointer> buffers_;
};

}  // namespace gnomon::apps::inspector
