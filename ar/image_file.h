// Pictures in and out of files, by OpenImageIO: png, jpeg, bmp, pnm, exr and hdr in, known by their
// first bytes; png out. Sizes are bounded before memory is taken; a damaged or truncated file is
// refused.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "ar/image.h"

namespace gnomon::ar {

/// Largest side and largest area of a picture in pixels.
inline constexpr int kMaxImageSide = 16384;
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 27;

/// A picture of floats: tightly packed rows from the top, r, g, b.
struct FloatImage {
  int width = 0, height = 0;
  std::vector<float> pixels;

  const float* at(int x, int y) const {
    return pixels.data() + (static_cast<std::size_t>(y) * width + x) * 3;
  }
  float* at(int x, int y) { return pixels.data() + (static_cast<std::size_t>(y) * width + x) * 3; }
};

/// Reads an 8-bit picture with 1, 3 or 4 channels; grey with alpha becomes r, g, b, a.
/// 16-bit values are scaled to 8 bits and rounded; floats are taken as linear light, clamped to
/// [0, 1] and sRGB-encoded. Alpha is as in the file (not multiplied in). An orientation tag is not
/// applied: a camera's calibration belongs to the pixels as stored.
/// Throws InputError.
Image read_image(const std::filesystem::path& path);

/// The same as three channels: grey is repeated, alpha left out.
Image read_image_rgb(const std::filesystem::path& path);

/// Decodes a PNG or JPEG file in memory; `name` stands for the file in messages.
/// Throws InputError.
Image decode_image(std::span<const std::uint8_t> bytes, std::string_view name);

/// Reads a picture as floats (EXR, HDR): channels R, G, B by name, or the one channel three times.
/// Floats are as stored; integers are divided by their largest value. Throws InputError, also for a
/// value that is not finite.
FloatImage read_float_image(const std::filesystem::path& path);

/// The picture as three channels: grey is repeated, alpha left out.
Image to_rgb(const Image& image);

/// The bytes of an 8-bit PNG file; `name` stands for the file in an InputError.
/// Precondition: the picture is not empty and its pixels fit its size.
std::vector<std::uint8_t> encode_png(const Image& image, std::string_view name);

/// The bytes of a JPEG file of that quality, 1 to 100; for looking at, since its pixels are only
/// near. Otherwise as encode_png. Precondition: 1 or 3 channels.
std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality, std::string_view name);

/// Writes an 8-bit PNG beside `path`, then renames it. Throws InputError if it cannot be written.
/// Precondition: the picture is not empty and its pixels fit its size.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace gnomon::ar
