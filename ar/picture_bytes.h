// The outer form of picture files, looked at before a codec does: which format it is, whether a
// PNG's chunks are whole, and PNG and JPEG files without their metadata. Codecs need neither text,
// colour profiles nor camera data for the pixels, and OpenImageIO 2.4 reads behind the end of
// damaged IPTC data; libpng writes what it meets to the terminal instead of telling its caller.
// Sources: PNG specification (W3C), sections 5 and annex D; ITU-T T.81, annex B.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace gnomon::ar {

/// The name of the format that the first bytes say, as OpenImageIO calls it: "png", "jpeg", "bmp",
/// "pnm", "openexr", "hdr". Empty for all others.
std::string_view picture_format(std::span<const std::uint8_t> bytes);

/// A PNG file with its critical chunks and its transparency alone.
/// Throws InputError (`name` stands for the file): a chunk that ends behind the file, a wrong check
/// sum, a missing first (IHDR) or last (IEND) chunk.
std::vector<std::uint8_t> bare_png(std::span<const std::uint8_t> bytes, std::string_view name);

/// A JPEG file without comments and application data, but for what colours depend on (JFIF's and
/// Adobe's segments). Throws InputError for a segment that ends behind the file.
std::vector<std::uint8_t> bare_jpeg(std::span<const std::uint8_t> bytes, std::string_view name);

}  // namespace gnomon::ar
