#include "ar/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/png_chunks.h"
#include "raster/check.h"

namespace gnomon::ar {

namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

// OpenImageIO also opens movies, terminals and procedural "null" pictures; a picture file here is
// one of these.
constexpr std::array<std::string_view, 9> kFormats{"png", "jpeg", "tiff",    "bmp", "pnm",
                                                   "tga", "webp", "openexr", "hdr"};

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
  const std::string format = input.format_name();
  if (std::find(kFormats.begin(), kFormats.end(), format) == kFormats.end())
    fail(name, fmt::format("format {} is not read", format));
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

/// Checks what OpenImageIO's codecs do not report.
void check_chunks(std::span<const std::uint8_t> bytes, std::string_view name) {
  if (!is_png(bytes)) return;
  if (const auto fault = png_fault(bytes)) fail(name, *fault);
}

ImageInput::unique_ptr open_file(const std::filesystem::path& path) {
  check_chunks(read_file(path, kMaxFileBytes), path.string());
  const ImageSpec options = open_options();
  // Absolute, so that no name is taken for something else than a file.
  ImageInput::unique_ptr input =
      ImageInput::open(std::filesystem::absolute(path).string(), &options);
  if (!input) {
    const std::string message = OIIO::geterror();
    fail(path.string(), message.empty() ? "cannot be opened as a picture" : message);
  }
  return input;
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
  return guarded(path.string(), [&] { return read_8bit(*open_file(path), path.string()); });
}

Image read_image_rgb(const std::filesystem::path& path) { return to_rgb(read_image(path)); }

Image decode_image(std::span<const std::uint8_t> bytes, std::string_view name) {
  static constexpr std::array<std::uint8_t, 3> kJpeg{0xff, 0xd8, 0xff};
  const bool is_jpeg =
      bytes.size() >= kJpeg.size() && std::equal(kJpeg.begin(), kJpeg.end(), bytes.begin());
  if (!is_jpeg && !is_png(bytes)) fail(name, "neither a PNG nor a JPEG picture");
  check_chunks(bytes, name);
  return guarded(name, [&] {
    OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
    ImageSpec options = open_options();
    // As an attribute, because open() with options and a reader finds no format.
    void* const pointer = &reader;
    options.attribute("oiio:ioproxy", TypeDesc::PTR, &pointer);
    ImageInput::unique_ptr input =
        ImageInput::open(is_jpeg ? "memory.jpg" : "memory.png", &options);
    if (!input) fail(name, OIIO::geterror());
    return read_8bit(*input, name);
  });
}

FloatImage read_float_image(const std::filesystem::path& path) {
  const std::string name = path.string();
  return guarded(name, [&] {
    ImageInput::unique_ptr input = open_file(path);
    check_spec(*input, name);
    const ImageSpec spec = input->spec();
    std::vector<int> channels = select_channels(spec, name);
    if (channels.size() == 1) channels.assign(3, channels[0]);
    channels.resize(3);
    FloatImage image{
        spec.width, spec.height,
        pick(read_all<float>(*input, TypeDesc::FLOAT, name), spec.nchannels, channels)};
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

void write_png(const std::filesystem::path& path, const Image& image) {
  raster::require(image.width >= 1 && image.height >= 1 &&
                      (image.channels == 1 || image.channels == 3 || image.channels == 4) &&
                      image.pixels.size() ==
                          static_cast<std::size_t>(image.width) * image.height * image.channels,
                  "a picture's pixels fit its size and its 1, 3 or 4 channels");
  PendingFile file(path);
  const auto output = OIIO::ImageOutput::create("png");
  if (!output) fail(path.string(), OIIO::geterror());
  ImageSpec spec(image.width, image.height, image.channels, TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  if (!output->open(file.temporary().string(), spec) ||
      !output->write_image(TypeDesc::UINT8, image.pixels.data()) || !output->close())
    fail(path.string(), fmt::format("cannot be written: {}", output->geterror()));
  file.commit();
}

}  // namespace gnomon::ar
