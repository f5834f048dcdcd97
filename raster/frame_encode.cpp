#include <algorithm>
#include <map>

#include <glm/gtc/type_ptr.hpp>

#include "raster/byte_io.h"
#include "raster/check.h"
#include "raster/frame_fields.h"
#include "raster/frame_format.h"
#include "raster/frame_tables.h"

namespace gnomon::raster {

namespace {

std::uint32_t checked_count(std::size_t count) {
  require(count < kNone, "a list of a frame file has fewer than 2^32 - 1 entries");
  return static_cast<std::uint32_t>(count);
}

/// Entries as they are written, each once, in the order in which they were first asked for.
class Table {
 public:
  std::uint32_t index_of(const std::vector<std::uint8_t>& entry) {
    const auto [place, added] =
        index_.try_emplace(std::string(entry.begin(), entry.end()), checked_count(order_.size()));
    if (added) order_.push_back(&place->first);
    return place->second;
  }
  void write(ByteWriter& out) const {
    out.u32(checked_count(order_.size()));
    for (const std::string* entry : order_) out.text(*entry);
  }

 private:
  /// By content. Strings, because GCC 12 warns of its own comparison of vectors of bytes.
  std::map<std::string, std::uint32_t> index_;
  std::vector<const std::string*> order_;
};

std::vector<std::uint8_t> array_entry(std::span<const std::uint32_t> indices) {
  const bool narrow = std::ranges::all_of(indices, [](std::uint32_t i) { return i <= 0xffff; });
  ByteWriter entry;
  entry.u8(static_cast<std::uint8_t>(narrow ? ArrayType::index16 : ArrayType::index32));
  entry.u32(checked_count(indices.size()));
  for (const std::uint32_t index : indices) {
    if (narrow)
      entry.u16(static_cast<std::uint16_t>(index));
    else
      entry.u32(index);
  }
  return entry.take();
}

template <glm::length_t kLength>
std::vector<std::uint8_t> array_entry(std::span<const glm::vec<kLength, float>> vectors) {
  constexpr ArrayType kTypes[] = {ArrayType::vec2, ArrayType::vec3, ArrayType::vec4};
  ByteWriter entry;
  entry.u8(static_cast<std::uint8_t>(kTypes[kLength - 2]));
  entry.u32(checked_count(vectors.size()));
  for (const auto& vector : vectors)
    for (glm::length_t i = 0; i < kLength; ++i) entry.f32(vector[i]);
  return entry.take();
}

BufferKind kind_of(const ColorBuffer&) { return BufferKind::color; }
BufferKind kind_of(const DepthBuffer&) { return BufferKind::depth; }
BufferKind kind_of(const StencilBuffer&) { return BufferKind::stencil; }
std::uint8_t format_of(const ColorBuffer& b) { return static_cast<std::uint8_t>(b.format()); }
std::uint8_t format_of(const DepthBuffer& b) { return static_cast<std::uint8_t>(b.format()); }
std::uint8_t format_of(const StencilBuffer&) { return 0; }

/// Writes the passes and gathers on the way what they refer to.
class Encoder {
 public:
  explicit Encoder(std::uint32_t version) : version_(version) {}

  void passes(std::span<const Pass> passes) {
    body_.u32(checked_count(passes.size()));
    for (const Pass& pass : passes) {
      text({}, pass.label);
      Targets targets = pass.targets;
      fields(*this, targets);
      body_.u32(checked_count(pass.commands.size()));
      for (Command command : pass.commands) alternative({}, command);
    }
  }

  std::vector<std::uint8_t> file() {
    ByteWriter out;
    out.text(kFrameMagic);
    out.u32(version_);
    out.u32(checked_count(buffer_index_.size()));
    out.bytes(buffers_.take());
    arrays_.write(out);
    textures_.write(out);
    pictures_.write(out);
    out.bytes(body_.take());
    return out.take();
  }

  // What fields() asks of a direction. Nothing is named: writing cannot fail.
  std::uint32_t version() const { return version_; }
  void byte(std::string_view, std::uint8_t value) { body_.u8(value); }
  void flag(std::string_view, bool value) { body_.u8(value); }
  void integer(std::string_view, int value) { body_.u32(static_cast<std::uint32_t>(value)); }
  void word(std::string_view, std::uint32_t value) { body_.u32(value); }
  void real(std::string_view, float value) { body_.f32(value); }
  template <class E>
  void choice(std::string_view, E value, E) {
    body_.u8(static_cast<std::uint8_t>(value));
  }
  void mask(std::string_view, const std::array<bool, 4>& write) {
    body_.u8(static_cast<std::uint8_t>(write[0] | write[1] << 1 | write[2] << 2 | write[3] << 3));
  }
  template <class T>
  void floats(std::string_view, const T& values) {
    for (std::size_t i = 0; i < sizeof(T) / sizeof(float); ++i)
      body_.f32(glm::value_ptr(values)[i]);
  }
  void text(std::string_view, const std::string& text) {
    body_.u32(checked_count(text.size()));
    body_.text(text);
  }
  template <class T>
  void optional(std::string_view, std::optional<T>& value) {
    body_.u8(value.has_value());
    if (value) fields(*this, *value);
  }
  template <class T>
  void list(std::string_view, const std::vector<T>& values) {
    body_.u32(checked_count(values.size()));
    for (T value : values) fields(*this, value);
  }
  template <class... T>
  void alternative(std::string_view, std::variant<T...>& value) {
    body_.u8(static_cast<std::uint8_t>(value.index()));
    std::visit([this](auto& of_kind) { fields(*this, of_kind); }, value);
  }
  template <class T>
  void array(std::string_view, std::span<const T> values) {
    body_.u32(values.empty() ? kNone : arrays_.index_of(array_entry(values)));
  }
  void texture(std::string_view, const std::shared_ptr<const Texture>& texture) {
    if (!texture) return body_.u32(kNone);
    ByteWriter entry;
    entry.u32(static_cast<std::uint32_t>(texture->width));
    entry.u32(static_cast<std::uint32_t>(texture->height));
    entry.u8(static_cast<std::uint8_t>(texture->wrap_s));
    entry.u8(static_cast<std::uint8_t>(texture->wrap_t));
    entry.u8(static_cast<std::uint8_t>(texture->filter));
    for (const Rgba8& texel : texture->texels) entry.bytes(texel);
    body_.u32(textures_.index_of(entry.take()));
  }
  void picture(std::string_view, const ImageView& image) {
    ByteWriter entry;
    entry.u32(static_cast<std::uint32_t>(image.width));
    entry.u32(static_cast<std::uint32_t>(image.height));
    entry.u8(static_cast<std::uint8_t>(image.channels));
    const std::size_t row = static_cast<std::size_t>(image.width) * image.channels;
    for (int y = 0; y < image.height; ++y) entry.bytes({image.pixel(0, y), row});
    body_.u32(pictures_.index_of(entry.take()));
  }
  template <class B>
  void target(std::string_view, const B* buffer) {
    if (!buffer) return body_.u32(kNone);
    const auto [place, added] =
        buffer_index_.try_emplace(buffer, checked_count(buffer_index_.size()));
    if (added) {
      buffers_.u8(static_cast<std::uint8_t>(kind_of(*buffer)));
      buffers_.u8(format_of(*buffer));
      buffers_.u32(static_cast<std::uint32_t>(buffer->width()));
      buffers_.u32(static_cast<std::uint32_t>(buffer->height()));
    }
    body_.u32(place->second);
  }
  void map(std::string_view what, const DepthBuffer* map) { target(what, map); }

 private:
  const std::uint32_t version_;
  ByteWriter body_, buffers_;
  /// Asked by address and never walked, so that no address is seen in the bytes.
  std::map<const void*, std::uint32_t> buffer_index_;
  Table arrays_, textures_, pictures_;
};

std::uint32_t version_of(const Command& command) {
  const Draw* draw = std::get_if<Draw>(&command);
  if (!draw) return 1;
  if (!draw->parts.empty()) return 3;
  const Lit* lit = std::get_if<Lit>(&draw->shading);
  return lit && lit->at_vertices ? 2 : 1;
}

/// The oldest version that has all fields of the frame: what older readers can read stays theirs.
std::uint32_t version_of(const Frame& frame) {
  std::uint32_t version = 1;
  for (const Pass& pass : frame.passes())
    for (const Command& command : pass.commands) version = std::max(version, version_of(command));
  return version;
}

}  // namespace

std::vector<std::uint8_t> encode_frame(const Frame& frame) {
  Encoder encoder(version_of(frame));
  encoder.passes(frame.passes());
  return encoder.file();
}

}  // namespace gnomon::raster
