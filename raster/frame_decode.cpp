#include <algorithm>
#include <memory>

#include <glm/gtc/type_ptr.hpp>

#include "raster/byte_io.h"
#include "raster/frame_fields.h"
#include "raster/frame_format.h"
#include "raster/frame_tables.h"

namespace gnomon::raster {

namespace {

using Array = std::variant<std::vector<glm::vec2>, std::vector<glm::vec3>, std::vector<glm::vec4>,
                           std::vector<std::uint32_t>>;

struct Picture {
  int width = 0, height = 0, channels = 0;
  std::vector<std::uint8_t> pixels;
};

/// What the commands of a decoded frame borrow; the frame keeps it.
struct Store {
  std::vector<Array> arrays;
  std::vector<std::shared_ptr<const Texture>> textures;
  std::vector<Picture> pictures;
};

constexpr std::uint64_t padded(std::uint32_t size) {
  return (std::uint64_t{size} + kTileSize - 1) / kTileSize * kTileSize;
}

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> bytes, std::uint64_t max_buffer_bytes)
      : in_(bytes), buffer_bytes_left_(max_buffer_bytes) {}

  RecordedFrame frame() {
    head();
    repeat("the number of buffers", [this] { buffer(); });
    repeat("the number of arrays", [this] { array(); });
    repeat("the number of textures", [this] { texture(); });
    repeat("the number of pictures", [this] { picture(); });
    out_.frame.keep(store_);
    repeat("the number of passes", [this] { pass(); });
    if (in_.left() != 0)
      in_.fail(in_.offset(), std::to_string(in_.left()) + " bytes follow the last pass");
    return std::move(out_);
  }

  // What fields() asks of a direction.
  std::uint32_t version() const { return version_; }
  void byte(std::string_view what, std::uint8_t& value) { value = in_.u8(what); }
  void flag(std::string_view what, bool& value) { value = number(what, 2) != 0; }
  void integer(std::string_view what, int& value) { value = static_cast<int>(in_.u32(what)); }
  void word(std::string_view what, std::uint32_t& value) { value = in_.u32(what); }
  void real(std::string_view what, float& value) { value = in_.f32(what); }
  template <class E>
  void choice(std::string_view what, E& value, E last) {
    value = static_cast<E>(number(what, static_cast<unsigned>(last) + 1));
  }
  void mask(std::string_view what, std::array<bool, 4>& write) {
    const unsigned bits = number(what, 16);
    for (unsigned i = 0; i < 4; ++i) write[i] = (bits >> i & 1) != 0;
  }
  template <class T>
  void floats(std::string_view what, T& values) {
    for (std::size_t i = 0; i < sizeof(T) / sizeof(float); ++i)
      glm::value_ptr(values)[i] = in_.f32(what);
  }
  void text(std::string_view what, std::string& text) {
    const auto bytes = in_.bytes(in_.u32(what), what);
    text.assign(bytes.begin(), bytes.end());
  }
  template <class T>
  void optional(std::string_view what, std::optional<T>& value) {
    value.reset();
    if (number(what, 2) != 0) fields(*this, value.emplace());
  }
  template <class T>
  void list(std::string_view what, std::vector<T>& values) {
    // Grows by what was read: the count itself makes no room.
    repeat(what, [&] { fields(*this, values.emplace_back()); });
  }
  template <class... T>
  void alternative(std::string_view what, std::variant<T...>& value) {
    static_assert(sizeof...(T) == 2);
    if (number(what, 2) == 0)
      fields(*this, value.template emplace<0>());
    else
      fields(*this, value.template emplace<1>());
  }
  template <class T>
  void array(std::string_view what, std::span<const T>& values) {
    const std::size_t at = in_.offset();
    const auto index = entry(what, store_->arrays.size());
    if (!index) return;
    const auto* array = std::get_if<std::vector<T>>(&store_->arrays[*index]);
    if (!array)
      in_.fail(at, std::string(what) + " are array " + std::to_string(*index) +
                       ", whose elements are of another type");
    values = *array;
  }
  void texture(std::string_view what, std::shared_ptr<const Texture>& texture) {
    if (const auto index = entry(what, store_->textures.size())) texture = store_->textures[*index];
  }
  void picture(std::string_view what, ImageView& image) {
    const std::size_t at = in_.offset();
    const auto index = entry(what, store_->pictures.size());
    if (!index) in_.fail(at, "a blit has no picture");
    const Picture& picture = store_->pictures[*index];
    image = {picture.pixels.data(), picture.width, picture.height, picture.channels,
             static_cast<std::ptrdiff_t>(picture.width) * picture.channels};
  }
  template <class B>
  void target(std::string_view what, B*& buffer) {
    const std::size_t at = in_.offset();
    const auto index = entry(what, out_.buffers.size());
    if (!index) return;
    buffer = std::get_if<B>(&out_.buffers[*index]);
    if (!buffer)
      in_.fail(at, std::string(what) + " is buffer " + std::to_string(*index) +
                       ", which is of another kind");
  }
  void map(std::string_view what, const DepthBuffer*& map) {
    DepthBuffer* buffer = nullptr;
    target(what, buffer);
    map = buffer;
  }

 private:
  template <class Read>
  void repeat(std::string_view what, Read read) {
    for (std::uint32_t left = in_.u32(what); left > 0; --left) read();
  }

  /// A byte below `end`.
  unsigned number(std::string_view what, unsigned end) {
    const std::size_t at = in_.offset();
    const unsigned value = in_.u8(what);
    if (value >= end)
      in_.fail(at, std::string(what) + " is " + std::to_string(value) + ", more than " +
                       std::to_string(end - 1));
    return value;
  }
  /// 1 to 16384, the range of a buffer's, a texture's and a picture's sides.
  std::uint32_t side(std::string_view what) {
    const std::size_t at = in_.offset();
    const std::uint32_t value = in_.u32(what);
    if (value < 1 || value > std::uint32_t{kMaxTargetSize})
      in_.fail(at,
               std::string(what) + " is " + std::to_string(value) + ", but it can be 1 to 16384");
    return value;
  }
  /// An index into a table of `count` entries; nothing for kNone.
  std::optional<std::uint32_t> entry(std::string_view what, std::size_t count) {
    const std::size_t at = in_.offset();
    const std::uint32_t index = in_.u32(what);
    if (index == kNone) return std::nullopt;
    if (index >= count)
      in_.fail(at, std::string(what) + ": index " + std::to_string(index) + " into a table of " +
                       std::to_string(count));
    return index;
  }
  /// Records through the frame's own checks; what they refuse is the file's fault.
  template <class Record>
  void record(std::size_t at, Record call) {
    try {
      call();
    } catch (const std::invalid_argument& misuse) {
      in_.fail(at, std::string("broken rule: ") + misuse.what());
    }
  }

  void head() {
    const auto magic = in_.bytes(kFrameMagic.size(), "the format's name");
    if (!std::equal(magic.begin(), magic.end(), kFrameMagic.begin()))
      in_.fail(0, "this does not begin with \"gnomon frame\"");
    const std::size_t at = in_.offset();
    const std::uint32_t version = in_.u32("the version");
    if (version < 1 || version > kFrameVersion)
      in_.fail(at, "the version is " + std::to_string(version) + "; versions 1 to 3 can be read");
    version_ = version;
  }

  void buffer() {
    const std::size_t at = in_.offset();
    const auto kind = static_cast<BufferKind>(number("a buffer's kind", 3));
    const unsigned format = number("a buffer's format", kind == BufferKind::stencil ? 1 : 2);
    const std::uint32_t width = side("a buffer's width"), height = side("a buffer's height");
    const std::uint64_t pixel_bytes = kind == BufferKind::stencil                ? 1
                                      : kind == BufferKind::color && format == 1 ? 16
                                                                                 : 4;
    const std::uint64_t bytes = padded(width) * padded(height) * pixel_bytes;
    if (bytes > buffer_bytes_left_)
      in_.fail(at, "a buffer takes " + std::to_string(bytes) + " bytes, but " +
                       std::to_string(buffer_bytes_left_) + " are left of those accepted");
    buffer_bytes_left_ -= bytes;
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    if (kind == BufferKind::color)
      out_.buffers.emplace_back(std::in_place_type<ColorBuffer>, w, h,
                                static_cast<ColorFormat>(format));
    else if (kind == BufferKind::depth)
      out_.buffers.emplace_back(std::in_place_type<DepthBuffer>, w, h,
                                static_cast<DepthFormat>(format));
    else
      out_.buffers.emplace_back(std::in_place_type<StencilBuffer>, w, h);
  }

  template <class T, class Read>
  void elements(std::uint32_t count, std::size_t element_bytes, Read read) {
    ByteReader data(in_.bytes(std::uint64_t{count} * element_bytes, "an array"));
    std::vector<T> values(count);
    for (T& value : values) read(data, value);
    store_->arrays.emplace_back(std::move(values));
  }
  template <class T>
  void vectors(std::uint32_t count) {
    elements<T>(count, sizeof(T), [](ByteReader& data, T& vector) {
      for (int i = 0; i < T::length(); ++i) vector[i] = data.f32({});
    });
  }
  void array() {
    const auto type = static_cast<ArrayType>(number("an array's type", 5));
    const std::uint32_t count = in_.u32("an array's length");
    switch (type) {
      case ArrayType::vec2:
        return vectors<glm::vec2>(count);
      case ArrayType::vec3:
        return vectors<glm::vec3>(count);
      case ArrayType::vec4:
        return vectors<glm::vec4>(count);
      case ArrayType::index16:
        return elements<std::uint32_t>(
            count, 2, [](ByteReader& data, std::uint32_t& index) { index = data.u16({}); });
      case ArrayType::index32:
        return elements<std::uint32_t>(
            count, 4, [](ByteReader& data, std::uint32_t& index) { index = data.u32({}); });
    }
  }

  void texture() {
    auto texture = std::make_shared<Texture>();
    const std::uint32_t width = side("a texture's width"), height = side("a texture's height");
    texture->width = static_cast<int>(width);
    texture->height = static_cast<int>(height);
    choice("a texture's wrap in s", texture->wrap_s, Wrap::mirrored_repeat);
    choice("a texture's wrap in t", texture->wrap_t, Wrap::mirrored_repeat);
    choice("a texture's filter", texture->filter, Filter::linear);
    const auto texels = in_.bytes(std::uint64_t{width} * height * 4, "a texture");
    texture->texels.resize(texels.size() / 4);
    for (std::size_t i = 0; i < texels.size(); ++i) texture->texels[i / 4][i % 4] = texels[i];
    store_->textures.push_back(std::move(texture));
  }

  void picture() {
    const std::uint32_t width = side("a picture's width"), height = side("a picture's height");
    const std::size_t at = in_.offset();
    const std::uint8_t channels = in_.u8("a picture's channels");
    if (channels != 3 && channels != 4)
      in_.fail(at, "a picture has " + std::to_string(channels) + " channels, but it can be 3 or 4");
    const auto pixels = in_.bytes(std::uint64_t{width} * height * channels, "a picture");
    store_->pictures.push_back({static_cast<int>(width),
                                static_cast<int>(height),
                                channels,
                                {pixels.begin(), pixels.end()}});
  }

  void pass() {
    const std::size_t at = in_.offset();
    std::string label;
    text("a pass's label", label);
    Targets targets;
    fields(*this, targets);
    record(at, [&] { out_.frame.begin_pass(label, targets); });
    repeat("the number of commands", [this] { command(); });
  }

  void command() {
    const std::size_t at = in_.offset();
    switch (number("a command's kind", 3)) {
      case 0: {
        Clear clear;
        fields(*this, clear);
        return record(at, [&] { out_.frame.clear(clear); });
      }
      case 1: {
        Draw draw;
        fields(*this, draw);
        return record(at, [&] { out_.frame.draw(std::move(draw)); });
      }
      default: {
        Blit blit;
        fields(*this, blit);
        return record(at, [&] { out_.frame.blit(blit); });
      }
    }
  }

  ByteReader in_;
  std::uint32_t version_ = kFrameVersion;
  std::uint64_t buffer_bytes_left_;
  std::shared_ptr<Store> store_ = std::make_shared<Store>();
  RecordedFrame out_;
};

}  // namespace

RecordedFrame decode_frame(std::span<const std::uint8_t> bytes, std::uint64_t max_buffer_bytes) {
  return Decoder(bytes, max_buffer_bytes).frame();
}

}  // namespace gnomon::raster
