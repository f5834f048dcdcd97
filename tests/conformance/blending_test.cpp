// Blending and colour masks. Grids: 5 operations x 15 x 15 factors for colour and for alpha over
// pairs of 8-bit values, all 256 x 256 pairs for some of them, all 16 colour masks, RGBA32F.
// Oracles: the slow reference for the bytes; for RGBA8 the exact rational, rounded by comparing
// integers.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "grid.h"
#include "raster/random_frames.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using gnomon::random_frames::Random;

namespace {

constexpr std::array<int, 16> kSamples{0,   1,   2,   3,   63,  64,  85,  127,
                                       128, 129, 170, 191, 192, 253, 254, 255};
constexpr std::array<float, 4> kConstant{51.0f / 255, 128.0f / 255, 1.0f, 77.0f / 255};
constexpr std::array<int, 4> kConstant8{51, 128, 255, 77};
using Ints = std::array<int, 4>;

template <class E>
E nth(int n) {
  return static_cast<E>(n);
}

/// A factor in 255ths: of pairs (value, one minus value) in OpenGL's order.
int factor(BlendFactor f, std::size_t c, const Ints& s, const Ints& d) {
  if (f == BlendFactor::src_alpha_saturate) return c == 3 ? 255 : std::min(s[3], 255 - d[3]);
  const std::array<int, 7> values{0, s[c], d[c], s[3], d[3], kConstant8[c], kConstant8[3]};
  const auto n = static_cast<std::size_t>(f);
  return n % 2 == 0 ? values[n / 2] : 255 - values[n / 2];
}

/// The nearest integer to numerator / 255 in [0, 255]; never a tie, 255 is odd.
int divided(int numerator) {
  for (int v = 0; v < 255; ++v)
    if (2 * numerator < 255 * (2 * v + 1)) return v;
  return 255;
}

int blended(const Blend& blend, std::size_t c, const Ints& s, const Ints& d) {
  const int a = s[c] * factor(c == 3 ? blend.src_alpha : blend.src_color, c, s, d);
  const int b = d[c] * factor(c == 3 ? blend.dst_alpha : blend.dst_color, c, s, d);
  switch (c == 3 ? blend.alpha_op : blend.color_op) {
    case BlendOp::add:
      return divided(a + b);
    case BlendOp::subtract:
      return divided(a - b);
    case BlendOp::reverse_subtract:
      return divided(b - a);
    case BlendOp::min:
      return std::min(s[c], d[c]);
    default:
      return std::max(s[c], d[c]);
  }
}

Blend all_channels(int op, int src, int dst) {
  Blend blend;
  blend.color_op = blend.alpha_op = nth<BlendOp>(op);
  blend.src_color = blend.src_alpha = nth<BlendFactor>(src);
  blend.dst_color = blend.dst_alpha = nth<BlendFactor>(dst);
  blend.constant = {kConstant[0], kConstant[1], kConstant[2], kConstant[3]};
  return blend;
}

/// A picture whose texel in row y is `of(y)`: the source colours.
std::shared_ptr<const Texture> column(int height, const std::function<Rgba8(int)>& of) {
  auto texture = std::make_shared<Texture>();
  texture->width = 1;
  texture->height = height;
  for (int y = 0; y < height; ++y) texture->texels.push_back(of(y));
  texture->filter = Filter::nearest;
  return texture;
}

void record_column(Frame& frame, const ColorState& color,
                   const std::shared_ptr<const Texture>& texture) {
  record_draw(
      frame, {.state = {.color = color}, .shading = Flat{{1, 1, 1, 1}, texture}},
      {.positions = full_quad(), .texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}});
}

Ints widened(const Rgba8& c) { return {c[0], c[1], c[2], c[3]}; }

std::uint8_t sample(std::size_t i) { return static_cast<std::uint8_t>(kSamples[i % 16]); }

/// Different values in the four channels, all samples over 16 rows.
Rgba8 source_row(int y) {
  const auto i = static_cast<std::size_t>(y);
  return {sample(i), sample(i + 5), sample(15 - i), sample(3 * i + 1)};
}
Rgba8 stored_column(int x) {
  const auto i = static_cast<std::size_t>(x);
  return {sample(i), sample(i + 7), sample(5 * i), sample(15 - i)};
}

std::string text(int op, int src, int dst) {
  return "op " + std::to_string(op) + " factors " + std::to_string(src) + " " + std::to_string(dst);
}

}  // namespace

TEST(Blending, EveryOperationAndFactorPairIsTheRoundedRational) {
  Grid grid("blending 5 x 15 x 15, RGBA8");
  const auto source = column(16, source_row);
  Buffers before({16, 16});
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) before.color.rgba8().at(x, y) = stored_column(x);
  for (int op = 0; op < 5; ++op)
    for (int src = 0; src < 15; ++src)
      for (int dst = 0; dst < 15; ++dst) {
        const Blend blend = all_channels(op, src, dst);
        const Expected expected = grid.check(text(op, src, dst), before, [&](Frame& frame, auto&) {
          record_column(frame, {.blend = blend}, source);
        });
        for (int y = 0; y < 16; ++y)
          for (int x = 0; x < 16; ++x)
            for (std::size_t c = 0; c < 4; ++c)
              ASSERT_EQ(expected.only().color.rgba8().at(x, y)[c],
                        blended(blend, c, widened(source_row(y)), widened(stored_column(x))))
                  << text(op, src, dst) << " channel " << c << " at " << x << ' ' << y;
      }
}

TEST(Blending, AlphaHasItsOwnOperationAndFactors) {
  Grid grid("blending separate alpha and masks");
  const auto source = column(16, source_row);
  Buffers before({16, 16});
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) before.color.rgba8().at(x, y) = stored_column(x);
  Random random(10);
  for (int round = 0; round < 400; ++round) {
    Blend blend = all_channels(random.integer(0, 4), random.integer(0, 14), random.integer(0, 14));
    blend.alpha_op = nth<BlendOp>(random.integer(0, 4));
    blend.src_alpha = nth<BlendFactor>(random.integer(0, 14));
    blend.dst_alpha = nth<BlendFactor>(random.integer(0, 14));
    ColorState color{.blend = blend};
    for (std::size_t c = 0; c < 4; ++c) color.write[c] = (round >> c & 1) != 0;
    const Expected expected =
        grid.check("round " + std::to_string(round), before,
                   [&](Frame& frame, auto&) { record_column(frame, color, source); });
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_EQ(expected.only().color.rgba8().at(x, y)[c],
                    color.write[c]
                        ? blended(blend, c, widened(source_row(y)), widened(stored_column(x)))
                        : stored_column(x)[c])
              << round;
  }
}

TEST(Blending, AllPairsOfBytesAreTheRoundedRational) {
  Grid grid("blending all 65536 pairs");
  constexpr std::array<std::array<int, 3>, 8> kBlends{
      {{0, 6, 7}, {0, 2, 3}, {0, 4, 8}, {0, 14, 1}, {1, 1, 6}, {2, 10, 1}, {3, 1, 1}, {4, 0, 0}}};
  const auto row = [](int y) {
    const auto v = static_cast<std::uint8_t>(y);
    return Rgba8{v, static_cast<std::uint8_t>(255 - y), static_cast<std::uint8_t>(y * 7), v};
  };
  const auto source = column(256, row);
  Buffers before({256, 256});
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x)
      before.color.rgba8().at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(x),
                                       static_cast<std::uint8_t>(x * 3),
                                       static_cast<std::uint8_t>(x)};
  for (const auto& [op, src, dst] : kBlends) {
    const Blend blend = all_channels(op, src, dst);
    const Expected expected = grid.check(
        text(op, src, dst), before,
        [&](Frame& frame, auto&) { record_column(frame, {.blend = blend}, source); },
        op == 0 ? Runs::every_variant : Runs::each_isa);
    for (int y = 0; y < 256; ++y)
      for (int x = 0; x < 256; ++x)
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_EQ(expected.only().color.rgba8().at(x, y)[c],
                    blended(blend, c, widened(row(y)), widened(before.color.rgba8().at(x, y))))
              << text(op, src, dst) << " at " << x << ' ' << y;
  }
}

TEST(Blending, OfFloatsEqualsTheReference) {
  Grid grid("blending 5 x 15 x 15, RGBA32F");
  Random random(11);
  Buffers before({16, 16}, DepthFormat::d24, ColorFormat::rgba32f);
  std::vector<glm::vec4> colors;
  const auto color = [&random] {
    glm::vec4 c;
    for (int i = 0; i < 4; ++i) c[i] = random.real(-2.0f, 3.0f);
    return c;
  };
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) before.color.rgba32f().at(x, y) = color();
  for (int i = 0; i < 6; ++i) colors.push_back(color());
  for (int op = 0; op < 5; ++op)
    for (int src = 0; src < 15; ++src)
      for (int dst = 0; dst < 15; ++dst) {
        ColorState state{.blend = all_channels(op, src, dst)};
        state.write[static_cast<std::size_t>(src % 4)] = dst % 5 != 0;
        grid.check(text(op, src, dst), before, [&](Frame& frame, auto&) {
          record_draw(frame, {.state = {.color = state}},
                      {.positions = full_quad(), .colors = colors});
        });
      }
}
