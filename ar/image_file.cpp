#include "ar/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/picture_bytes.h"
#include "raster/check.h"

namespace gnomon::ar {

namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 31;

[[noreturn]] void fail(std::string_view name, std::string_view what) {
  throw InputError(fmt::format("{}: {}", one_line(name), one_line(what)));
}

std::string message_of(const ImageInput& input) {
  const std::string message = input.geterror();
  return message.empty() ? "damaged" : message;
}

void check_spec(const ImageInput& input, std::string_view name) {
  const ImageSpec& spec = input.spec();
  if (spec.deep || spec.depth > 1) fail(name, "deep and volume pictures are not read");
  const std::int64_t area = std::int64_t{spec.width} * spec.height;
  if (spec.width < 1 || spec.height < 1 || spec.width > kMaxImageSide ||
      spec.height > kMaxImageSide || area > kMaxImagePixels)
    fail(name, fmt::format("{} x {} pixels; 1 to {} a side and at most {} in all are read",
                           spec.width, spec.height, kMaxImageSide, kMaxImagePixels));
  if (spec.tile_width > kMaxImageSide || spec.tile_height > kMaxImageSide ||
      std::int64_t{spec.tile_width} * spec.tile_height > kMaxImagePixels)
    fail(name, fmt::format("tiles of {} x {} pixels", spec.tile_width, spec.tile_height));
  if (spec.nchannels < 1 || spec.nchannels > 64 || area * spec.nchannels > (std::int64_t{1} << 30))
    fail(name, fmt::format("{} channels of {} x {} pixels are not read", spec.nchannels, spec.width,
                           spec.height));
}

ImageSpec open_options() {
  ImageSpec options;
  options.attribute("oiio:UnassociatedAlpha", 1);
  return options;
}

/// Which channels of the file become r, g, b (and a), or the one grey channel.
std::vector<int> select_channels(const ImageSpec& spec, std::string_view name) {
  const auto index = [&spec](const char* channel) { return spec.channelindex(channel); };
  const int alpha = spec.alpha_channel;
  if (spec.nchannels == 1) return {0};
  if (spec.nchannels == 2 && alpha == 1) return {0, 0, 0, 1};
  if (spec.nchannels == 3) return {0, 1, 2};
  if (spec.nchannels == 4 && alpha == 3) return {0, 1, 2, 3};
  const int r = index("R"), g = index("G"), b = index("B");
  if (r >= 0 && g >= 0 && b >= 0)
    return alpha >= 0 ? std::vector<int>{r, g, b, alpha} : std::vector<int>{r, g, b};
  fail(name, fmt::format("{} channels without R, G and B", spec.nchannels));
}

template <class T>
std::vector<T> read_all(ImageInput& input, TypeDesc type, std::string_view name) {
  const ImageSpec& spec = input.spec();
  std::vector<T> values(static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels);
  // A truncated JPEG reads with success and a message: both count.
  if (!input.read_image(0, 0, 0, spec.nchannels, type, values.data()) || input.has_error())
    fail(name, message_of(input));
  return values;
}

template <class T>
std::vector<T> pick(const std::vector<T>& values, int file_channels,
                    const std::vector<int>& channels) {
  std::vector<T> picked;
  picked.reserve(values.size() / static_cast<std::size_t>(file_channels) * channels.size());
  for (std::size_t at = 0; at < values.size(); at += static_cast<std::size_t>(file_channels))
    for (const int channel : channels)
      picked.push_back(values[at + static_cast<std::size_t>(channel)]);
  return picked;
}

/// IEC 61966-2-1.
std::uint8_t encode_srgb(float linear) {
  const float v = std::isnan(linear) ? 0.0f : std::clamp(linear, 0.0f, 1.0f);
  const float e = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(e * 255.0f));
}

Image read_8bit(ImageInput& input, std::string_view name) {
  check_spec(input, name);
  const ImageSpec spec = input.spec();
  const std::vector<int> channels = select_channels(spec, name);
  Image image{spec.width, spec.height, static_cast<int>(channels.size()), {}};
  if (!spec.format.is_floating_point()) {
    std::vector<std::uint8_t> values = read_all<std::uint8_t>(input, TypeDesc::UINT8, name);
    image.pixels = static_cast<int>(channels.size()) == spec.nchannels && channels.size() != 2
                       ? std::move(values)
                       : pick(values, spec.nchannels, channels);
    return image;
  }
  const std::vector<float> values =
      pick(read_all<float>(input, TypeDesc::FLOAT, name), spec.nchannels, channels);
  image.pixels.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_alpha = channels.size() == 4 && i % 4 == 3;
    image.pixels[i] =
        is_alpha
            ? static_cast<std::uint8_t>(std::lround(std::clamp(values[i], 0.0f, 1.0f) * 255.0f))
            : encode_srgb(values[i]);
  }
  return image;
}

/// A picture that is being decoded, with the memory that it is decoded from.
struct Source {
  std::vector<std::uint8_t> bytes;
  std::unique_ptr<OIIO::Filesystem::IOMemReader> reader;
  ImageInput::unique_ptr input;
};

/// Opens a file's bytes by the reader that their beginning asks for, and no other: OpenImageIO's
/// own choice also knows movies, terminals and made-up pictures. PNG and JPEG are decoded from
/// memory; `path` is where the other formats are read from, empty if they are not welcome.
Source open_bytes(std::vector<std::uint8_t> bytes, std::string_view name,
                  const std::filesystem::path& path) {
  Source source;
  const std::string format(picture_format(bytes));
  const bool in_memory = format == "png" || format == "jpeg";
  if (format.empty() || (!in_memory && path.empty()))
    fail(name, path.empty() ? "neither a PNG nor a JPEG picture"
                            : "not a picture (png, jpeg, bmp, pnm, exr and hdr are read)");
  source.input = ImageInput::create(format);
  if (!source.input) fail(name, OIIO::geterror());
  ImageSpec spec;
  if (in_memory) {
    source.bytes = format == "png" ? bare_png(bytes, name) : bare_jpeg(bytes, name);
    source.reader =
        std::make_unique<OIIO::Filesystem::IOMemReader>(source.bytes.data(), source.bytes.size());
    source.input->set_ioproxy(source.reader.get());
  }
  // Absolute, so that no name is taken for something else than a file.
  const std::string from =
      in_memory ? "memory." + format : std::filesystem::absolute(path).string();
  if (!source.input->open(from, spec, open_options())) fail(name, message_of(*source.input));
  return source;
}

/// Runs a read and turns what a codec throws into the one exception.
template <class Read>
auto guarded(std::string_view name, Read read) {
  try {
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail(name, "too large for this machine's memory");
  } catch (const std::exception& e) {
    fail(name, e.what());
  }
}

}  // namespace

Image read_image(const std::filesystem::path& path) {
  const std::string name = path.string();
  return guarded(name, [&] {
    const Source source = open_bytes(read_file(path, kMaxFileBytes), name, path);
    return read_8bit(*source.input, name);
  });
}

Image read_image_rgb(const std::filesystem::path& path) { return to_rgb(read_image(path)); }

Image decode_image(std::span<const std::uint8_t> bytes, std::string_view name) {
  return guarded(name, [&] {
    const Source source = open_bytes({bytes.begin(), bytes.end()}, name, {});
    return read_8bit(*source.input, name);
  });
}

FloatImage read_float_image(const std::filesystem::path& path) {
  const std::string name = path.string();
  return guarded(name, [&] {
    const Source source = open_bytes(read_file(path, kMaxFileBytes), name, path);
    check_spec(*source.input, name);
    const ImageSpec spec = source.input->spec();
    std::vector<int> channels = select_channels(spec, name);
    if (channels.size() == 1) channels.assign(3, channels[0]);
    channels.resize(3);
    FloatImage image{
        spec.width, spec.height,
        pick(read_all<float>(*source.input, TypeDesc::FLOAT, name), spec.nchannels, channels)};
    const auto bad = std::find_if(image.pixels.begin(), image.pixels.end(),
                                  [](float v) { return !std::isfinite(v); });
    if (bad != image.pixels.end()) {
      const auto pixel = (bad - image.pixels.begin()) / 3;
      fail(name,
           fmt::format("pixel ({}, {}) is {}", pixel % image.width, pixel / image.width, *bad));
    }
    return image;
  });
}

Image to_rgb(const Image& image) {
  if (image.channels == 3) return image;
  const std::vector<int> channels =
      image.channels == 1 ? std::vector<int>{0, 0, 0} : std::vector<int>{0, 1, 2};
  return {image.width, image.height, 3, pick(image.pixels, image.channels, channels)};
}

namespace {

/// Encoded in memory: OpenImageIO does not say when a disk is full.
std::vector<std::uint8_t> encode(const Image& image, const char* format, const ImageSpec& spec,
                                 std::string_view name) {
  raster::require(image.width >= 1 && image.height >= 1 &&
                      image.pixels.size() ==
                          static_cast<std::size_t>(image.width) * image.height * image.channels,
                  "a picture's pixels fit its size");
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) fail(name, OIIO::geterror());
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!output->set_ioproxy(&memory) || !output->open(std::string("picture.") + format, spec) ||
      !output->write_image(TypeDesc::UINT8, image.pixels.data()) || !output->close())
    fail(name, fmt::format("cannot be written: {}", output->geterror()));
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image, std::string_view name) {
  raster::require(image.channels == 1 || image.channels == 3 || image.channels == 4,
                  "a PNG has 1, 3 or 4 channels");
  ImageSpec spec(image.width, image.height, image.channels, TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  return encode(image, "png", spec, name);
}

std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality, std::string_view name) {
  raster::require(image.channels == 1 || image.channels == 3, "a JPEG has 1 or 3 channels");
  raster::require(quality >= 1 && quality <= 100, "a JPEG's quality is 1 to 100");
  ImageSpec spec(image.width, image.height, image.channels, TypeDesc::UINT8);
  spec.attribute("Compression", fmt::format("jpeg:{}", quality));
  return encode(image, "jpeg", spec, name);
}

void write_png(const std::filesystem::path& path, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image, path.string());
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace gnomon::ar
