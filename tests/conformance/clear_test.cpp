// Clears under scissor and masks. Grid: dEQP depth_stencil_clear.* (plain, scissored, masked, both)
// with colour clears of both formats. Oracles: the slow reference for the bytes, and closed forms:
// a pixel inside the scissor has the new value in the written bits, any other its old one.
#include <gtest/gtest.h>

#include <algorithm>

#include "every_value.h"
#include "grid.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;

namespace {

const std::array<std::optional<Rect>, 9> kScissors{
    std::nullopt,       Rect{0, 0, 1, 1},   Rect{2, 1, 3, 3},
    Rect{-5, -5, 8, 8}, Rect{5, 3, 99, 99}, Rect{3, 3, 0, 4},
    Rect{3, 3, 4, -1},  Rect{60, 60, 8, 8}, Rect{-9, 2, 400, 61}};

bool inside(const std::optional<Rect>& r, int x, int y) {
  return !r || (x >= r->x && x < r->x + r->width && y >= r->y && y < r->y + r->height);
}

}  // namespace

TEST(Clear, OfDepthAndStencilWritesItsBitsInsideTheScissor) {
  Grid grid("clear depth and stencil");
  for (const DepthFormat format : kDepthFormats)
    for (const Size size : kSizes)
      for (const auto& scissor : kScissors)
        for (const bool depth_write : {false, true})
          for (const int mask : {0x00, 0x0f, 0x80, 0xff})
            for (const auto& values :
                 {std::pair{-1.0f, -1}, {0.0f, 0}, {0.25f, 255}, {1.0f, 0x1a5}, {2.0f, 77}}) {
              const float depth = values.first;
              const int stencil = values.second;
              const Buffers before = every_value(size, format);
              const std::string name = text(size) + " mask " + std::to_string(mask) + " stencil " +
                                       std::to_string(stencil);
              const Expected expected = grid.check(name, before, [&](Frame& frame, auto&) {
                frame.clear({.depth = depth,
                             .stencil = stencil,
                             .depth_write = depth_write,
                             .stencil_write_mask = static_cast<std::uint8_t>(mask),
                             .scissor = scissor});
              });
              // Quarters of 2^n - 1 lie a quarter below an integer's half: 0.25 one is 0.75 past
              // one.
              const std::uint32_t one = format == DepthFormat::d24 ? 0xffffff : 0xffff;
              const std::uint32_t z = depth <= 0 ? 0 : depth >= 1 ? one : (one + 1) / 4;
              for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x) {
                  const bool in = inside(scissor, x, y);
                  const int old = before.stencil.at(x, y);
                  ASSERT_EQ(expected.only().stencil.at(x, y),
                            in ? (old & ~mask & 255) | (stencil & mask) : old)
                      << name;
                  ASSERT_EQ(expected.only().depth.at(x, y),
                            in && depth_write ? z : before.depth.at(x, y))
                      << name;
                }
            }
}

TEST(Clear, OfColorWritesItsChannelsInsideTheScissor) {
  Grid grid("clear colour masks");
  for (const ColorFormat format : {ColorFormat::rgba8, ColorFormat::rgba32f})
    for (const Size size : kSizes)
      for (const auto& scissor : kScissors)
        for (int mask = 0; mask < 16; ++mask) {
          const std::array<bool, 4> write{(mask & 1) != 0, (mask & 2) != 0, (mask & 4) != 0,
                                          (mask & 8) != 0};
          const glm::vec4 old{0.2f, 0.4f, 0.6f, 0.8f}, color{1.5f, -0.5f, 0.0f, 1.0f};
          const std::string name = text(size) + " channels " + std::to_string(mask);
          const Expected expected =
              grid.check(name, Buffers(size, DepthFormat::d24, format), [&](Frame& frame, auto&) {
                frame.clear({.color = old});
                frame.clear({.color = color, .color_write = write, .scissor = scissor});
              });
          const bool clamped = format == ColorFormat::rgba8;
          for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
              for (int c = 0; c < 4; ++c) {
                const float written = clamped ? std::clamp(color[c], 0.0f, 1.0f) : color[c];
                ASSERT_EQ(
                    expected.only().color.at(x, y)[c],
                    inside(scissor, x, y) && write[static_cast<std::size_t>(c)] ? written : old[c])
                    << name;
              }
        }
}
