#include "apps/inspector/frame_buffers.h"

#include "raster/looked_up.h"

namespace gnomon::apps::inspector {

namespace {

const void* address(const BufferPointer& buffer) {
  return std::visit([](const auto* b) -> const void* { return b; }, buffer);
}

raster::ColorBuffer fresh(const raster::ColorBuffer& b) {
  return {b.width(), b.height(), b.format()};
}
raster::DepthBuffer fresh(const raster::DepthBuffer& b) {
  return {b.width(), b.height(), b.format()};
}
raster::StencilBuffer fresh(const raster::StencilBuffer& b) { return {b.width(), b.height()}; }

}  // namespace

FrameBuffers::FrameBuffers(const raster::Frame& frame) {
  for (const raster::Pass& pass : frame.passes()) {
    add_new(pass.targets.color);
    add_new(pass.targets.depth);
    add_new(pass.targets.stencil);
    // A frame lends its maps to be read; whoever inspects it executes it, and so draws into them.
    for (const raster::Command& command : pass.commands)
      raster::for_each_map(command, [&](const raster::DepthBuffer* map) {
        add_new(const_cast<raster::DepthBuffer*>(map));
      });
  }
}

template <class Buffer>
void FrameBuffers::add_new(Buffer* buffer) {
  if (buffer && !number_of(buffer)) buffers_.emplace_back(buffer);
}

std::optional<std::size_t> FrameBuffers::number_of(const void* buffer) const {
  for (std::size_t i = 0; buffer && i < buffers_.size(); ++i)
    if (address(buffers_[i]) == buffer) return i;
  return std::nullopt;
}

std::size_t FrameBuffers::bytes() const {
  std::size_t sum = 0;
  for (const BufferPointer& buffer : buffers_) {
    const auto pixels = std::visit(
        [](const auto* b) { return static_cast<std::size_t>(b->width()) * b->height(); }, buffer);
    const auto* color = std::get_if<raster::ColorBuffer*>(&buffer);
    const bool is_float = color && (*color)->format() == raster::ColorFormat::rgba32f;
    sum += pixels * (std::holds_alternative<raster::StencilBuffer*>(buffer) ? 1
                     : is_float                                             ? 16
                                                                            : 4);
  }
  return sum;
}

std::vector<raster::Buffer> FrameBuffers::save() const {
  std::vector<raster::Buffer> out;
  for (const BufferPointer& buffer : buffers_)
    std::visit([&](const auto* b) { out.emplace_back(*b); }, buffer);
  return out;
}

void FrameBuffers::restore(const std::vector<raster::Buffer>& saved) const {
  for (std::size_t i = 0; i < buffers_.size(); ++i)
    std::visit([&](auto* b) { *b = std::get<std::remove_pointer_t<decltype(b)>>(saved[i]); },
               buffers_[i]);
}

void FrameBuffers::reset() const {
  for (const BufferPointer& buffer : buffers_) std::visit([](auto* b) { *b = fresh(*b); }, buffer);
}

}  // namespace gnomon::apps::inspector
