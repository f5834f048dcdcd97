#include "ar/image_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "ar/error.h"
#include "ar/file.h"
#include "tests/ar/temporary_folder.h"

namespace gnomon::ar {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kImages = fs::path(GNOMON_SOURCE_DIR) / "tests/data/images";

/// A picture in which every byte is another function of its place.
Image pattern(int width, int height, int channels) {
  Image image{width, height, channels, {}};
  for (int i = 0; i < width * height * channels; ++i)
    image.pixels.push_back(static_cast<std::uint8_t>(i * 37 + i / 7));
  return image;
}

// Oracle: the round trip is the identity.
TEST(ImageFile, PngKeepsEveryByteOfGreyRgbAndRgbaWithItsAlpha) {
  const TemporaryFolder folder;
  for (const int channels : {1, 3, 4}) {
    const Image image = pattern(13, 7, channels);
    write_png(folder.path() / "p.png", image);
    const Image back = read_image(folder.path() / "p.png");
    EXPECT_EQ(back.width, 13);
    EXPECT_EQ(back.height, 7);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.pixels, image.pixels) << channels << " channels";
  }
}

// Oracle: the bytes inside the file (grey 127, alpha 128).
TEST(ImageFile, GreyWithAlphaBecomesRgbaAsStored) {
  const Image image = read_image(kImages / "grey_alpha.png");
  ASSERT_EQ(image.channels, 4);
  EXPECT_THAT(std::vector<std::uint8_t>(image.at(2, 1), image.at(2, 1) + 4),
              ::testing::ElementsAre(127, 127, 127, 128));
  const Image rgb = read_image_rgb(kImages / "grey_alpha.png");
  ASSERT_EQ(rgb.channels, 3);
  EXPECT_THAT(rgb.pixels, ::testing::Each(127));
}

// Oracle: round(value * 255 / 65535) of the file's 16-bit values 16384, 8192, 4096.
TEST(ImageFile, SixteenBitsAreScaledAndRounded) {
  const Image image = read_image(kImages / "ramp16.png");
  EXPECT_THAT(std::vector<std::uint8_t>(image.at(1, 0), image.at(1, 0) + 3),
              ::testing::ElementsAre(64, 32, 16));
}

// Oracle: IEC 61966-2-1 by hand: 0.5 -> 188, 0.25 -> 137; 4 is beyond white.
TEST(ImageFile, FloatsBecomeSrgb) {
  for (const char* name : {"halves.exr", "halves.hdr"}) {
    const Image image = read_image(kImages / name);
    EXPECT_THAT(std::vector<std::uint8_t>(image.at(3, 2), image.at(3, 2) + 3),
                ::testing::ElementsAre(188, 137, 255))
        << name;
  }
}

// Oracle: the constant the files were made with.
TEST(ImageFile, FloatPicturesKeepTheirValues) {
  for (const char* name : {"halves.exr", "halves.hdr"}) {
    const FloatImage image = read_float_image(kImages / name);
    EXPECT_EQ(image.width, 4);
    EXPECT_EQ(image.height, 3);
    EXPECT_THAT(std::vector<float>(image.at(3, 2), image.at(3, 2) + 3),
                ::testing::ElementsAre(0.5f, 0.25f, 4.0f))
        << name;
  }
}

// Oracle: the decoder of files on disk.
TEST(ImageFile, MemoryDecodesAsTheFileDoes) {
  for (const char* name : {"checker.jpg", "ramp16.png"}) {
    const auto bytes = read_file(kImages / name, 1 << 20);
    EXPECT_EQ(decode_image(bytes, name).pixels, read_image(kImages / name).pixels) << name;
  }
}

std::string message_of(const fs::path& path) {
  try {
    read_image(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// Oracle: a prefix of a file is not the file. PNG and JPEG end with a marker of 12 and 2 bytes
// that holds no pixel; everything shorter lacks data.
TEST(ImageFile, EveryTruncationIsRefusedWithTheFileInTheMessage) {
  const TemporaryFolder folder;
  for (const char* name : {"checker.jpg", "ramp16.png", "halves.exr", "halves.hdr"}) {
    const auto bytes = read_file(kImages / name, 1 << 20);
    const std::size_t trailer = std::string(name) == "ramp16.png" ? 12 : 2;
    for (std::size_t length = 0; length + trailer < bytes.size(); ++length) {
      const fs::path path = folder.path() / name;
      write_file(path, {reinterpret_cast<const char*>(bytes.data()), length});
      const std::string message = message_of(path);
      EXPECT_THAT(message, HasSubstr(name)) << name << " cut to " << length;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

// Oracle: the chunk layout of the file.
TEST(ImageFile, ADamagedPngNamesTheChunkAndTheByte) {
  const TemporaryFolder folder;
  const auto bytes = read_file(kImages / "ramp16.png", 1 << 20);
  std::string bad(bytes.begin(), bytes.end());
  bad[20] = static_cast<char>(~bad[20]);
  write_file(folder.path() / "b.png", bad);
  EXPECT_THAT(message_of(folder.path() / "b.png"),
              HasSubstr("b.png: damaged: wrong check sum of chunk IHDR at byte 8"));
  write_file(folder.path() / "b.png", {reinterpret_cast<const char*>(bytes.data()), 40});
  EXPECT_THAT(message_of(folder.path() / "b.png"), HasSubstr("truncated"));
}

// Oracle: the same pixels. The metadata is what OpenImageIO 2.4 reads behind the end of: an IPTC
// record (APP13) that says it is longer than its segment.
TEST(ImageFile, MetadataIsNotShownToTheCodec) {
  const TemporaryFolder folder;
  const auto bytes = read_file(kImages / "checker.jpg", 1 << 20);
  std::string text(bytes.begin(), bytes.end());
  const std::string iptc = std::string("Photoshop 3.0\0", 14) + "8BIM" +
                           std::string("\x04\x04\0\0\x7f\xff\xff\xff\x1c\x02\x05\x7f\xff", 13);
  const std::string segment = std::string("\xff\xed\0", 3) + static_cast<char>(iptc.size() + 2);
  text.insert(2, segment + iptc);
  write_file(folder.path() / "iptc.jpg", text);
  EXPECT_EQ(read_image(folder.path() / "iptc.jpg").pixels,
            read_image(kImages / "checker.jpg").pixels);
}

// Oracle: no crash, and a picture of the stated size if it is one; run under ASan and UBSan too.
TEST(ImageFile, FlippedBytesNeverCrash) {
  const TemporaryFolder folder;
  for (const char* name : {"checker.jpg", "ramp16.png", "halves.exr", "halves.hdr"}) {
    const auto bytes = read_file(kImages / name, 1 << 20);
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      std::string bad(bytes.begin(), bytes.end());
      bad[at] = static_cast<char>(~bad[at]);
      write_file(folder.path() / name, bad);
      try {
        const Image image = read_image(folder.path() / name);
        EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(image.width) * image.height *
                                           static_cast<std::size_t>(image.channels));
      } catch (const InputError&) {
      }
    }
  }
}

TEST(ImageFile, SizesBeyondTheBoundAreRefusedBeforeMemoryIsTaken) {
  const TemporaryFolder folder;
  write_file(folder.path() / "huge.ppm", "P6\n2000000000 1000000000\n255\nabc");
  EXPECT_THAT(message_of(folder.path() / "huge.ppm"), HasSubstr("2000000000 x 1000000000"));
  write_file(folder.path() / "wide.ppm", "P6\n16385 1\n255\nabc");
  EXPECT_THAT(message_of(folder.path() / "wide.ppm"), HasSubstr("16385 x 1"));
}

TEST(ImageFile, WhatIsNoPictureFileIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of(folder.path() / "absent.png"), HasSubstr("absent.png: no such file"));
  EXPECT_THAT(message_of(folder.path()), HasSubstr("not a regular file"));
  write_file(folder.path() / "text.png", "this is no picture");
  EXPECT_THAT(message_of(folder.path() / "text.png"), HasSubstr("text.png: not a picture"));
  write_file(folder.path() / "x.null", "?RES=4096x4096");
  EXPECT_THAT(message_of(folder.path() / "x.null"), HasSubstr("x.null: not a picture"));
  EXPECT_THROW(decode_image({}, "nothing"), InputError);
}

TEST(ImageFile, AFolderThatIsMissingOrIsTheTargetLeavesNothingBehind) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_png(folder.path() / "no/such/p.png", pattern(2, 2, 3)), InputError);
  fs::create_directory(folder.path() / "p.png");
  EXPECT_THROW(write_png(folder.path() / "p.png", pattern(2, 2, 3)), InputError);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(ImageFile, MisuseNamesTheRule) {
  EXPECT_THROW(write_png("x.png", Image{2, 2, 3, {1, 2, 3}}), std::invalid_argument);
  EXPECT_THROW(write_png("x.png", Image{}), std::invalid_argument);
}

TEST(PendingFile, WithoutCommitTheTargetKeepsItsBytes) {
  const TemporaryFolder folder;
  const fs::path target = folder.path() / "t.txt";
  write_file(target, "before");
  {
    const PendingFile pending(target);
    std::ofstream(pending.temporary()) << "half";
    EXPECT_EQ(pending.temporary().extension(), ".txt");
  }
  const auto bytes = read_file(target, 100);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "before");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace gnomon::ar
