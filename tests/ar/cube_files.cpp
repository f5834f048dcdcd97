#include "tests/ar/cube_files.h"

#include <array>
#include <bit>
#include <cstdint>

namespace gnomon::ar::test {
namespace {

constexpr int kTriangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                   {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                   {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};

std::array<int, 3> corner(int i) { return {i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1}; }

std::string words(int i) {
  const auto c = corner(i);
  return std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]);
}

template <class Unsigned>
std::string little(Unsigned value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    bytes += static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}

std::string floats(int i) {
  std::string bytes;
  for (const int c : corner(i)) bytes += little(std::bit_cast<std::uint32_t>(float(c)));
  return bytes;
}

std::string chunk(std::uint16_t id, const std::string& data) {
  return little(id) + little(static_cast<std::uint32_t>(data.size() + 6)) + data;
}

std::string obj() {
  std::string text;
  for (int i = 0; i < 8; ++i) text += "v " + words(i) + "\n";
  for (const auto& t : kTriangles)
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  return text;
}

std::string faces_in_words() {
  std::string text;
  for (int i = 0; i < 8; ++i) text += words(i) + "\n";
  for (const auto& t : kTriangles)
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) +
            "\n";
  return text;
}

std::string ascii_stl() {
  std::string text = "solid cube\n";
  for (const auto& t : kTriangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int i : t) text += "vertex " + words(i) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid cube\n";
}

std::string binary_stl() {
  std::string bytes(80, ' ');
  bytes += little(std::uint32_t{12});
  for (const auto& t : kTriangles) {
    bytes += std::string(12, '\0');
    for (const int i : t) bytes += floats(i);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement "
         "face 12\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string binary_ply() {
  std::string bytes = ply_header("binary_little_endian");
  for (int i = 0; i < 8; ++i) bytes += floats(i);
  for (const auto& t : kTriangles) {
    bytes += '\3';
    for (const int i : t) bytes += little(static_cast<std::uint32_t>(i));
  }
  return bytes;
}

std::string three_ds() {
  std::string vertices = little(std::uint16_t{8}), faces = little(std::uint16_t{12});
  for (int i = 0; i < 8; ++i) vertices += floats(i);
  for (const auto& t : kTriangles) {
    for (const int i : t) faces += little(static_cast<std::uint16_t>(i));
    faces += little(std::uint16_t{0});
  }
  const std::string mesh = chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces));
  return chunk(0x4d4d, chunk(0x3d3d, chunk(0x4000, std::string("cube\0", 5) + mesh)));
}

}  // namespace

std::map<std::string, std::string> cube_files() {
  return {{"cube.obj", obj()},
          {"cube.off", "OFF\n8 12 0\n" + faces_in_words()},
          {"ascii.stl", ascii_stl()},
          {"binary.stl", binary_stl()},
          {"ascii.ply", ply_header("ascii") + faces_in_words()},
          {"binary.ply", binary_ply()},
          {"cube.3ds", three_ds()}};
}

}  // namespace gnomon::ar::test
