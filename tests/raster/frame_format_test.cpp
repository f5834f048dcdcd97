// The frame format. Oracles: the bytes written down here and in docs/frame-format.md, executing the
// frame that was encoded, and the contract that bad bytes are refused in one sentence.
#include "raster/frame_format.h"

#include <bit>
#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "random_frames.h"
#include "raster/execute.h"

namespace gnomon {
namespace {

using namespace raster;
using random_frames::Random;
using testing::HasSubstr;
using testing::StartsWith;
using Bytes = std::vector<std::uint8_t>;

/// Every byte of a buffer, row after row.
Bytes bytes_of(const Buffer& buffer) {
  Bytes out;
  const auto word = [&](std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
      out.push_back(static_cast<std::uint8_t>(value >> shift));
  };
  if (const auto* stencil = std::get_if<StencilBuffer>(&buffer)) return stencil->to_rows();
  if (const auto* depth = std::get_if<DepthBuffer>(&buffer)) {
    for (const std::uint32_t value : depth->to_rows()) word(value);
    return out;
  }
  const auto& color = std::get<ColorBuffer>(buffer);
  if (color.format() == ColorFormat::rgba8) return color.to_rgba8_rows();
  for (int y = 0; y < color.height(); ++y)
    for (int x = 0; x < color.width(); ++x)
      for (int i = 0; i < 4; ++i) word(std::bit_cast<std::uint32_t>(color.rgba32f().at(x, y)[i]));
  return out;
}

DepthLookup random_lookup(Random& r, const DepthBuffer& map) {
  DepthLookup lookup;
  lookup.map = &map;
  for (int i = 0; i < 16; ++i) lookup.map_from_position[i / 4][i % 4] = r.real(-1.0f, 1.0f);
  lookup.func = static_cast<CompareFunc>(r.integer(0, 7));
  lookup.filter = static_cast<Filter>(r.integer(0, 1));
  if (r.chance(0.5f))
    lookup.border.reset();
  else
    lookup.border = r.real(0.0f, 1.0f);
  return lookup;
}

struct SharedMesh {
  std::vector<glm::vec4> positions{
      {-1.0f, -0.9f, 0.1f, 1.0f}, {0.9f, -0.8f, 0.5f, 1.1f}, {0.1f, 1.0f, -0.2f, 0.9f}};
  std::vector<glm::vec3> normals{{0.0f, 0.0f, 1.0f}, {0.6f, 0.0f, 0.8f}, {0.0f, 0.6f, 0.8f}};
  std::vector<std::uint32_t> indices{0, 1, 2};
};

/// Draws that all borrow one mesh and look up `map`, flat and lit.
void record_lookups(Frame& frame, Random& r, const Targets& targets, const DepthBuffer& map,
                    const std::shared_ptr<SharedMesh>& mesh) {
  frame.begin_pass("lookups", targets);
  for (int i = 0; i < 6; ++i) {
    Draw draw;
    draw.state = random_frames::random_state(r, targets.width(), targets.height());
    draw.mesh = {mesh->positions, mesh->indices, mesh->normals};
    draw.clip_from_model[3] = {r.real(-0.5f, 0.5f), r.real(-0.5f, 0.5f), 0.0f, 1.0f};
    draw.label = "draw " + std::to_string(i);
    if (r.chance(0.5f)) draw.parts = {{"none", 0}, {"all", 0}, {"beyond", 3}};
    if (r.chance(0.5f)) {
      Flat flat;
      flat.depth_lookup = random_lookup(r, map);
      flat.depth_texture_mode = static_cast<DepthTextureMode>(r.integer(0, 2));
      draw.shading = flat;
    } else {
      Lit lit;
      lit.lights.resize(2);
      lit.at_vertices = r.chance(0.3f);
      if (!lit.at_vertices) lit.lights[0].shadow_map = random_lookup(r, map);
      lit.eye_world = {0.0f, 0.0f, 3.0f};
      draw.shading = lit;
    }
    frame.draw(draw);
  }
}

/// Random passes to targets of two sizes, depth lookups between them and a mesh that they share.
RecordedFrame random_recording(std::uint32_t seed) {
  Random r(seed);
  RecordedFrame out;
  const auto buffers = [&](int width, int height) {
    auto& color = out.buffers.emplace_back(std::in_place_type<ColorBuffer>, width, height,
                                           static_cast<ColorFormat>(r.integer(0, 1)));
    auto& depth = out.buffers.emplace_back(std::in_place_type<DepthBuffer>, width, height,
                                           static_cast<DepthFormat>(r.integer(0, 1)));
    auto& stencil = out.buffers.emplace_back(std::in_place_type<StencilBuffer>, width, height);
    return Targets{&std::get<ColorBuffer>(color), &std::get<DepthBuffer>(depth),
                   &std::get<StencilBuffer>(stencil)};
  };
  const int map_width = r.integer(1, 70), map_height = r.integer(1, 70);
  const Targets light = buffers(map_width, map_height);
  const int width = r.integer(1, 70), height = r.integer(1, 70);
  const Targets eye = buffers(width, height);
  auto mesh = std::make_shared<SharedMesh>();
  out.frame.keep(mesh);
  random_frames::record_pass(out.frame, seed + 1, 8, light);
  record_lookups(out.frame, r, eye, *light.depth, mesh);
  random_frames::record_pass(out.frame, seed + 2, 12, eye);
  record_lookups(out.frame, r, {.color = light.color}, *eye.depth, mesh);
  return out;
}

/// A frame of one stencil buffer, one clear and one triangle.
RecordedFrame tiny_recording() {
  RecordedFrame out;
  auto& stencil =
      std::get<StencilBuffer>(out.buffers.emplace_back(std::in_place_type<StencilBuffer>, 3, 2));
  auto mesh = std::make_shared<SharedMesh>();
  mesh->positions = {{0.0f, 0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 2.0f, 0.0f, 1.0f}};
  out.frame.keep(mesh);
  out.frame.begin_pass("p", {.stencil = &stencil});
  out.frame.clear({.stencil = -1, .stencil_write_mask = 0x7f});
  out.frame.draw({.state = {.stencil = StencilState{{.pass = StencilOp::incr_wrap}, {}},
                            .color = ColorState::off(),
                            .scissor = Rect{0, -1, 2, 9}},
                  .mesh = {mesh->positions, mesh->indices},
                  .stencil_ref = {258, -7},
                  .label = "abc"});
  return out;
}

/// The words of a table in docs/frame-format.md: hexadecimal digits, spaces for people.
Bytes from_hex(const std::string& text) {
  std::string digits;
  for (const char c : text)
    if (c != ' ') digits += c;
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes.push_back(
        static_cast<std::uint8_t>(std::strtoul(digits.substr(i, 2).c_str(), nullptr, 16)));
  return bytes;
}

std::string error_of(const Bytes& bytes, std::uint64_t limit = kMaxFrameBufferBytes) {
  try {
    decode_frame(bytes, limit);
  } catch (const FormatError& error) {
    return error.what();
  }
  return "no error";
}

/// Targets of more are no use to a test of bad bytes.
constexpr std::uint64_t kTestLimit = 1 << 20;

/// Decodes and runs, or is refused with a sentence; anything else is an error that the test sees.
void expect_frame_or_error(const Bytes& bytes) {
  try {
    const RecordedFrame got = decode_frame(bytes, kTestLimit);
    execute(got.frame, {.threads = 1, .isa = Isa::scalar});
  } catch (const FormatError& error) {
    EXPECT_THAT(error.what(), StartsWith("byte "));
  }
}

TEST(FrameFormat, AFrameComesBackWithTheSameBytesInTheFileAndInEveryBuffer) {
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    const RecordedFrame original = random_recording(seed);
    const Bytes bytes = encode_frame(original.frame);
    const RecordedFrame got = decode_frame(bytes);
    ASSERT_EQ(encode_frame(got.frame), bytes) << "seed " << seed;
    ASSERT_EQ(got.buffers.size(), original.buffers.size());
    execute(original.frame, {.threads = 1});
    execute(got.frame, {.threads = 1});
    for (std::size_t i = 0; i < got.buffers.size(); ++i)
      ASSERT_EQ(bytes_of(got.buffers[i]), bytes_of(original.buffers[i]))
          << "seed " << seed << ", buffer " << i;
  }
}

TEST(FrameFormat, ATinyFrameHasTheseBytes) {
  const Bytes expected = from_hex(
      "676e6f6d6f6e206672616d65 01000000"             // "gnomon frame", version 1
      "01000000  02 00 03000000 02000000"             // a stencil buffer of 3x2
      "02000000"                                      // two arrays
      "02 03000000"                                   // three vec4
      "00000000 00000000 00000000 0000803f"           //
      "0000803f 00000000 00000000 0000803f"           //
      "00000000 00000040 00000000 0000803f"           //
      "03 03000000  0000 0100 0200"                   // three indices
      "00000000 00000000"                             // no texture, no picture
      "01000000  01000000 70"                         // a pass "p"
      "ffffffff ffffffff 00000000"                    // its targets
      "02000000"                                      // two commands
      "00  00 00 01 ffffffff  0f 01 7f  00"           // clear: stencil -1
      "01  03000000 616263"                           // draw "abc"
      "00  01 07 ff ff 00 00 04  07 ff ff 00 00 00"   // no depth; stencil, front and back
      "00 00  00 00  00"                              // colour off; no culling, ccw; no offset
      "01 00000000 ffffffff 02000000 09000000"        // scissor
      "00  00000000 0000803f  00"                     // no viewport; range 0 to 1; no clamp
      "00000000 01000000 ffffffff ffffffff ffffffff"  // positions and indices
      "0000803f 00000000 00000000 00000000"           // clip_from_model
      "00000000 0000803f 00000000 00000000"           //
      "00000000 00000000 0000803f 00000000"           //
      "00000000 00000000 00000000 0000803f"           //
      "02010000 f9ffffff"                             // stencil references 258 and -7
      "00  0000803f 0000803f 0000803f 0000803f"       // flat, white
      "ffffffff 00 00");                              // no texture, no lookup, luminance
  EXPECT_EQ(encode_frame(tiny_recording().frame), expected);
}

TEST(FrameFormat, OnlyAFrameThatIsLitAtVerticesIsVersion2) {  // oracle: docs/frame-format.md
  const auto mesh = std::make_shared<SharedMesh>();
  const auto bytes_of_lit = [&](bool at_vertices) {
    RecordedFrame out;
    auto& color =
        std::get<ColorBuffer>(out.buffers.emplace_back(std::in_place_type<ColorBuffer>, 4, 4));
    out.frame.begin_pass("", {.color = &color});
    out.frame.draw({.mesh = {mesh->positions, mesh->indices, mesh->normals},
                    .shading = Lit{.at_vertices = at_vertices}});
    return encode_frame(out.frame);
  };
  const auto lit_of = [](const RecordedFrame& got) {
    return std::get<Lit>(std::get<Draw>(got.frame.passes()[0].commands[0]).shading);
  };
  const Bytes old = bytes_of_lit(false), now = bytes_of_lit(true);
  EXPECT_EQ(old.at(12), 1);
  EXPECT_EQ(now.at(12), 2);
  EXPECT_EQ(now.size(), old.size() + 1);
  EXPECT_FALSE(lit_of(decode_frame(old)).at_vertices);
  EXPECT_TRUE(lit_of(decode_frame(now)).at_vertices);
  // After the flag: eye, two matrices, texture.
  Bytes flagless = now;
  flagless.at(now.size() - (3 + 16 + 9 + 1) * 4 - 1) = 0;
  EXPECT_EQ(encode_frame(decode_frame(flagless).frame), old);
}

TEST(FrameFormat, OnlyAFrameWhoseMeshesHavePartsIsVersion3) {  // oracle: docs/frame-format.md
  RecordedFrame recording = tiny_recording();
  const Bytes old = encode_frame(recording.frame);
  auto draw = std::get<Draw>(recording.frame.passes()[0].commands[1]);
  draw.parts = {{"cap", 0}, {"rest", 3}};
  Frame frame;
  frame.begin_pass("p", recording.frame.passes()[0].targets);
  frame.clear(std::get<Clear>(recording.frame.passes()[0].commands[0]));
  frame.draw(draw);
  const Bytes now = encode_frame(frame);
  EXPECT_EQ(old.at(12), 1);
  EXPECT_EQ(now.at(12), 3);
  // A list of two texts with an index each; two_sided lighting's flag is of lit draws alone.
  EXPECT_EQ(now.size(), old.size() + 4 + (4 + 3 + 4) + (4 + 4 + 4));
  const RecordedFrame got = decode_frame(now);
  EXPECT_EQ(std::get<Draw>(got.frame.passes()[0].commands[1]).parts, draw.parts);
  for (const std::vector<MeshPart>& wrong :
       {std::vector<MeshPart>{{"a", 1}}, {{"a", 6}}, {{"a", 3}, {"b", 0}}}) {
    draw.parts = wrong;
    EXPECT_THROW(frame.draw(draw), std::invalid_argument);
  }
}

TEST(FrameFormat,
     AnIndexBeyond16BitsWidensItsArray) {  // oracle: sizes, and the frame that was read
  const auto bytes_with = [](std::uint32_t last) {
    RecordedFrame out;
    auto& stencil =
        std::get<StencilBuffer>(out.buffers.emplace_back(std::in_place_type<StencilBuffer>, 1, 1));
    const std::vector<glm::vec4> positions(70000, glm::vec4(1.0f));
    const std::vector<std::uint32_t> indices{0, 1, last};
    out.frame.begin_pass("", {.stencil = &stencil});
    out.frame.draw({.mesh = {positions, indices}});
    return encode_frame(out.frame);
  };
  EXPECT_EQ(bytes_with(65536).size(), bytes_with(65535).size() + 6);
  for (const std::uint32_t last : {65535u, 65536u}) {
    const RecordedFrame got = decode_frame(bytes_with(last));
    EXPECT_EQ(std::get<Draw>(got.frame.passes()[0].commands[0]).mesh.indices[2], last);
  }
}

TEST(FrameFormat, EqualArraysTexturesAndPicturesAreStoredOnce) {  // oracle: sizes
  const auto size = [](int copies) {
    RecordedFrame out;
    auto& color =
        std::get<ColorBuffer>(out.buffers.emplace_back(std::in_place_type<ColorBuffer>, 4, 4));
    out.frame.begin_pass("", {.color = &color});
    for (int i = 0; i < copies; ++i) {
      auto mesh = std::make_shared<SharedMesh>();
      mesh->positions.resize(1000, glm::vec4(0.0f));
      auto texture = std::make_shared<Texture>(Texture{40, 40, std::vector<Rgba8>(1600)});
      auto picture = std::make_shared<Bytes>(3 * 50 * 50);
      auto texcoords = std::make_shared<std::vector<glm::vec2>>(1000);
      out.frame.keep(mesh);
      out.frame.keep(picture);
      out.frame.keep(texcoords);
      out.frame.draw({.mesh = {mesh->positions, mesh->indices, {}, {}, *texcoords},
                      .shading = Flat{.texture = texture}});
      out.frame.blit({.image = ImageView::from_top_row(picture->data(), 50, 50, 3)});
    }
    return encode_frame(out.frame).size();
  };
  EXPECT_GT(size(1), 1000u * 24 + 1600 * 4 + 7500);
  EXPECT_EQ(size(3) - size(2), size(2) - size(1));
  EXPECT_LT(size(2) - size(1), 300u);
}

TEST(FrameFormat, APictureSeenFromItsTopRowIsStoredFromItsBottomRow) {  // oracle: the buffer
  const Bytes top_first{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  Bytes seen[2];
  for (const bool flipped : {false, true}) {
    RecordedFrame out;
    auto& color =
        std::get<ColorBuffer>(out.buffers.emplace_back(std::in_place_type<ColorBuffer>, 2, 2));
    out.frame.begin_pass("", {.color = &color});
    out.frame.blit({.image = flipped ? ImageView::from_top_row(top_first.data(), 2, 2, 3)
                                     : ImageView{top_first.data(), 2, 2, 3, 6}});
    const RecordedFrame got = decode_frame(encode_frame(out.frame));
    execute(got.frame);
    seen[flipped] = bytes_of(got.buffers[0]);
  }
  EXPECT_EQ(seen[0], (Bytes{1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 10, 11, 12, 0}));
  EXPECT_EQ(seen[1], (Bytes{7, 8, 9, 0, 10, 11, 12, 0, 1, 2, 3, 0, 4, 5, 6, 0}));
}

TEST(FrameFormat, EveryTruncationIsRefused) {
  const Bytes bytes = encode_frame(random_recording(3).frame);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    // A block of its own length, so that a sanitizer sees a read past its end.
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    ASSERT_THAT(error_of(cut), StartsWith("byte ")) << length;
  }
}

TEST(FrameFormat, FlippedBytesDecodeOrAreRefused) {
  Random r(77);
  for (std::uint32_t seed = 1; seed <= 25; ++seed) {
    const Bytes bytes = encode_frame(random_recording(seed).frame);
    for (int i = 0; i < 150; ++i) {
      Bytes bad = bytes;
      for (int flips = r.integer(1, 4); flips > 0; --flips) {
        const auto at = static_cast<std::size_t>(r.integer(0, static_cast<int>(bad.size()) - 1));
        bad[at] = static_cast<std::uint8_t>(r.chance(0.3f) ? 0xff : r.integer(0, 255));
      }
      expect_frame_or_error(bad);
    }
  }
}

TEST(FrameFormat, AnExtremeWordAnywhereDecodesOrIsRefused) {
  const Bytes bytes = encode_frame(tiny_recording().frame);
  for (const std::uint8_t value : Bytes{0x00, 0x7f, 0x80, 0xff})
    for (std::size_t at = 16; at + 4 <= bytes.size(); ++at) {
      Bytes bad = bytes;
      for (std::size_t i = 0; i < 4; ++i) bad[at + i] = value;
      expect_frame_or_error(bad);
    }
}

TEST(FrameFormat, AnErrorSaysWhereAndWhatAndTheValue) {
  const Bytes good = encode_frame(tiny_recording().frame);
  const auto with = [&](std::size_t at, std::uint8_t value) {
    Bytes bad = good;
    bad.at(at) = value;
    return error_of(bad);
  };
  EXPECT_EQ(error_of({}), "byte 0: the format's name takes 12 bytes, but 0 are left");
  EXPECT_EQ(with(3, 'x'), "byte 0: this does not begin with \"gnomon frame\"");
  EXPECT_EQ(with(12, 9), "byte 12: the version is 9; versions 1 to 3 can be read");
  EXPECT_EQ(with(20, 3), "byte 20: a buffer's kind is 3, more than 2");
  EXPECT_EQ(with(21, 1), "byte 21: a buffer's format is 1, more than 0");
  EXPECT_EQ(with(23, 0x40), "byte 22: a buffer's width is 16387, but it can be 1 to 16384");
  EXPECT_EQ(with(34, 5), "byte 34: an array's type is 5, more than 4");
  EXPECT_EQ(with(38, 0x10), "byte 39: an array takes 4294967344 bytes, but 273 are left");
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_EQ(error_of(longer),
            "byte " + std::to_string(good.size()) + ": 1 bytes follow the last pass");
  EXPECT_EQ(error_of(good, 4095),
            "byte 20: a buffer takes 4096 bytes, but 4095 are left of those accepted");
  EXPECT_EQ(error_of(good, 4096), "no error");
}

TEST(FrameFormat, WhatAFrameDoesNotTakeIsRefusedWithItsRule) {
  Bytes bytes = encode_frame(tiny_recording().frame);
  bytes.at(96) = 3;  // the first index of three positions
  EXPECT_THAT(error_of(bytes), HasSubstr("broken rule: an index lies below the number"));
}

}  // namespace
}  // namespace gnomon
