// The outer form of a PNG file: chunks with lengths and check sums. Checked before decoding,
// because libpng writes what it meets to the terminal instead of telling its caller. Source: PNG
// specification (W3C), sections 5 and annex D.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace gnomon::ar {

/// Whether the bytes mean to be a PNG file: the first four of its signature.
bool is_png(std::span<const std::uint8_t> bytes);

/// What is wrong with the chunks of a PNG file: a chunk that ends behind the file, a wrong check
/// sum, a missing first (IHDR) or last (IEND) chunk. Nothing if all is well.
std::optional<std::string> png_fault(std::span<const std::uint8_t> bytes);

}  // namespace gnomon::ar
