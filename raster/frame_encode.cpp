#include <map>
#include <type_traits>

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

void put(ByteWriter& out, std::uint32_t value) { out.u32(value); }

template <class T>
requires(!std::is_integral_v<T>) void put(ByteWriter& out, const T& vector) {
  for (int i = 0; i < T::length(); ++i) out.f32(vector[i]);
}

template <class T>
constexpr ArrayType kArrayType = std::is_same_v<T, glm::vec2>   ? ArrayType::vec2
                                 : std::is_same_v<T, glm::vec3> ? ArrayType::vec3
                                 : std::is_same_v<T, glm::vec4> ? ArrayType::vec4
                                                                : ArrayType::index;

BufferKind kind_of(const ColorBuffer&) { return BufferKind::color; }
BufferKind kind_of(const DepthBuffer&) { return BufferKind::depth; }
BufferKind kind_of(const StencilBuffer&) { return BufferKind::stencil; }
std::uint8_t format_of(const ColorBuffer& b) { return static_cast<std::uint8_t>(b.format()); }
std::uint8_t format_of(const DepthBuffer& b) { return static_cast<std::uint8_t>(b.format()); }
std::uint8_t format_of(const StencilBuffer&) { return 0; }

/// Writes the passes and gathers on the way what they refer to.
class Encoder {
 public:
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
    out.u32(kFrameVersion);
    out.u32(checked_count(buffer_index_.size()));
    out.bytes(buffers_.take());
    arrays_.write(out);
    textures_.write(out);
    pictures_.write(out);
    out.bytes(body_.take());
    return out.take();
  }

  // What fields() asks of a direction. Nothing is named: writing cannot fail.
  void byte(std::string_view, std::uint8_t value) { body_.u8(value); }
  void flag(std::string_view, bool value) { body_.u8(value); }
  void integer(std::string_view, int value) { body_.u32(static_cast<std::uint32_t>(value)); }
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
    if (values.empty()) return body_.u32(kNone);
    ByteWriter entry;
    entry.u8(static_cast<std::uint8_t>(kArrayType<T>));
    entry.u32(checked_count(values.size()));
    for (const T& value : values) put(entry, value);
    body_.u32(arrays_.index_of(entry.take()));
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
  ByteWriter body_, buffers_;
  /// Asked by address and never walked, so that no address is seen in the bytes.
  std::map<const void*, std::uint32_t> buffer_index_;
  Table arrays_, textures_, pictures_;
};

}  // namespace

std::vector<std::uint8_t> encode_frame(const Frame& frame) {
  Encoder encoder;
  encoder.passes(frame.passes());
  return encoder.file();
}

}  // namespace gnomon::raster
