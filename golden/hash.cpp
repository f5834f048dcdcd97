#include "golden/hash.h"

#include <bit>
#include <ostream>

namespace gnomon::golden {
namespace {

using raster::ColorBuffer;
using raster::DepthBuffer;
using raster::StencilBuffer;
using Bytes = std::vector<std::uint8_t>;

void append_word(Bytes& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

Bytes plane_bytes(const ColorBuffer& color) {
  if (color.format() == raster::ColorFormat::rgba8) return color.to_rgba8_rows();
  Bytes bytes;
  for (int y = 0; y < color.height(); ++y)
    for (int x = 0; x < color.width(); ++x) {
      const glm::vec4 c = color.rgba32f().at(x, y);
      for (int i = 0; i < 4; ++i) append_word(bytes, std::bit_cast<std::uint32_t>(c[i]));
    }
  return bytes;
}

Bytes plane_bytes(const DepthBuffer& depth) {
  Bytes bytes;
  for (const std::uint32_t value : depth.to_rows()) append_word(bytes, value);
  return bytes;
}

Bytes plane_bytes(const StencilBuffer& stencil) { return stencil.to_rows(); }

void describe(const ColorBuffer& color, BufferHash& out) {
  out.kind = "color";
  out.format = color.format() == raster::ColorFormat::rgba8 ? "rgba8" : "rgba32f";
}

void describe(const DepthBuffer& depth, BufferHash& out) {
  out.kind = "depth";
  out.format = depth.format() == raster::DepthFormat::d24 ? "d24" : "d16";
}

void describe(const StencilBuffer&, BufferHash& out) {
  out.kind = "stencil";
  out.format = "s8";
}

}  // namespace

std::string hash_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[hash >> shift & 15];
  return digits;
}

std::vector<std::uint8_t> bytes_of(const raster::Buffer& buffer) {
  return std::visit([](const auto& plane) { return plane_bytes(plane); }, buffer);
}

BufferHash hash_of(const raster::Buffer& buffer) {
  BufferHash out;
  std::visit(
      [&](const auto& plane) {
        describe(plane, out);
        out.width = plane.width();
        out.height = plane.height();
      },
      buffer);
  out.hash = hash_of(bytes_of(buffer));
  return out;
}

std::vector<BufferHash> hashes_of(const raster::RecordedFrame& recorded) {
  std::vector<BufferHash> hashes;
  for (const raster::Buffer& buffer : recorded.buffers) hashes.push_back(hash_of(buffer));
  return hashes;
}

std::string sentence(const BufferHash& h) {
  return h.kind + " " + h.format + " " + std::to_string(h.width) + "x" + std::to_string(h.height) +
         " " + h.hash;
}

void PrintTo(const BufferHash& hash, std::ostream* out) { *out << sentence(hash); }

}  // namespace gnomon::golden
