#include "ar/base64.h"

#include <array>
#include <bit>

namespace gnomon::ar {
namespace {

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::int8_t, 256> inverse_alphabet() {
  std::array<std::int8_t, 256> inverse{};
  inverse.fill(-1);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i)
    inverse[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::int8_t>(i);
  return inverse;
}

std::string encode(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = bytes.size() - i;
    std::uint32_t group = static_cast<std::uint32_t>(bytes[i]) << 16;
    if (here > 1) group |= static_cast<std::uint32_t>(bytes[i + 1]) << 8;
    if (here > 2) group |= bytes[i + 2];
    for (std::size_t k = 0; k < 4; ++k)
      text += k > here ? '=' : kAlphabet[(group >> (18 - 6 * k)) & 63u];
  }
  return text;
}

std::optional<std::vector<std::uint8_t>> decode(std::string_view text) {
  static constexpr std::array<std::int8_t, 256> kInverse = inverse_alphabet();
  if (text.size() % 4 != 0) return std::nullopt;
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t group = 0;
  for (std::size_t i = 0; i < text.size() - padding; ++i) {
    const std::int8_t digit = kInverse[static_cast<unsigned char>(text[i])];
    if (digit < 0) return std::nullopt;
    group = (group << 6) | static_cast<std::uint32_t>(digit);
    if (i % 4 == 3)
      for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(group >> shift));
  }
  if (padding == 1) {
    if ((group & 3u) != 0) return std::nullopt;
    bytes.push_back(static_cast<std::uint8_t>(group >> 10));
    bytes.push_back(static_cast<std::uint8_t>(group >> 2));
  } else if (padding == 2) {
    if ((group & 15u) != 0) return std::nullopt;
    bytes.push_back(static_cast<std::uint8_t>(group >> 4));
  }
  return bytes;
}

}  // namespace

std::string base64_from_integers(std::span<const std::uint32_t> values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * values.size());
  for (const std::uint32_t value : values)
    for (const int shift : {0, 8, 16, 24})
      bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  return encode(bytes);
}

std::string base64_from_bytes(std::span<const std::uint8_t> bytes) { return encode(bytes); }

std::string base64_from_floats(std::span<const float> values) {
  std::vector<std::uint32_t> bits;
  bits.reserve(values.size());
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return base64_from_integers(bits);
}

std::optional<std::vector<std::uint32_t>> integers_from_base64(std::string_view text) {
  const auto bytes = decode(text);
  if (!bytes || bytes->size() % 4 != 0) return std::nullopt;
  std::vector<std::uint32_t> values;
  values.reserve(bytes->size() / 4);
  for (std::size_t i = 0; i < bytes->size(); i += 4) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k)
      value |= static_cast<std::uint32_t>((*bytes)[i + k]) << (8 * k);
    values.push_back(value);
  }
  return values;
}

std::optional<std::vector<float>> floats_from_base64(std::string_view text) {
  const auto bits = integers_from_base64(text);
  if (!bits) return std::nullopt;
  std::vector<float> values;
  values.reserve(bits->size());
  for (const std::uint32_t value : *bits) values.push_back(std::bit_cast<float>(value));
  return values;
}

}  // namespace gnomon::ar
