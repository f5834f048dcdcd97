// Rows of numbers as base64 text (RFC 4648, with padding) of their little-endian bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::ar {

std::string base64_from_bytes(std::span<const std::uint8_t> bytes);
std::string base64_from_floats(std::span<const float> values);
std::string base64_from_integers(std::span<const std::uint32_t> values);

/// Absent unless the text is base64 of whole 4-byte numbers in its one canonical form.
std::optional<std::vector<float>> floats_from_base64(std::string_view text);
std::optional<std::vector<std::uint32_t>> integers_from_base64(std::string_view text);

}  // namespace gnomon::ar
