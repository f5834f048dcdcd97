#include "ar/video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "ar/error.h"
#include "ar/file.h"
#include "tests/ar/temporary_folder.h"

namespace gnomon::ar {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kVideo = fs::path(GNOMON_SOURCE_DIR) / "examples/desk/video/handle.avi";

/// A smooth picture whose brightness tells its number.
Image frame_of(int width, int height, int number) {
  Image image{width, height, 3, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.pixels.push_back(static_cast<std::uint8_t>(20 * number + x / 4));
      image.pixels.push_back(static_cast<std::uint8_t>(90 + y / 4));
      image.pixels.push_back(static_cast<std::uint8_t>(200 - 10 * number));
    }
  return image;
}

std::string message_of(const fs::path& path) {
  try {
    VideoReader::open_file(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

// Oracle: the frames that were written; codecs are lossy, so a bound: 4 of 255 on the mean.
TEST(Video, WrittenFramesComeBackInOrderWithSizeRateAndColours) {
  const TemporaryFolder folder;
  for (const char* name : {"v.avi", "v.mp4"}) {
    VideoWriter writer(folder.path() / name, 64, 48, 12.5);
    for (int i = 0; i < 7; ++i) writer.write(frame_of(64, 48, i));
    EXPECT_FALSE(fs::exists(folder.path() / name)) << "not before close()";
    writer.close();

    VideoReader reader = VideoReader::open_file(folder.path() / name);
    EXPECT_EQ(reader.width(), 64);
    EXPECT_EQ(reader.height(), 48);
    EXPECT_NEAR(reader.frames_per_second(), 12.5, 1e-6);
    for (int i = 0; i < 7; ++i) {
      const auto frame = reader.next();
      ASSERT_TRUE(frame) << name << " frame " << i;
      EXPECT_EQ(frame->index, i);
      EXPECT_NEAR(frame->time_s, i / 12.5, 1e-3) << name;
      const Image expected = frame_of(64, 48, i);
      double error = 0.0;
      for (std::size_t k = 0; k < expected.pixels.size(); ++k)
        error += std::abs(expected.pixels[k] - frame->image.pixels[k]);
      EXPECT_LT(error / static_cast<double>(expected.pixels.size()), 4.0) << name << " " << i;
    }
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.frames_read(), 7);
    EXPECT_EQ(reader.missing_frames(), 0);
  }
}

// Oracle: the size asked for.
TEST(Video, AviKeepsOddSizesAndMp4RefusesThem) {
  const TemporaryFolder folder;
  VideoWriter writer(folder.path() / "odd.avi", 33, 21, 10.0);
  writer.write(frame_of(33, 21, 0));
  writer.close();
  const VideoReader reader = VideoReader::open_file(folder.path() / "odd.avi");
  EXPECT_EQ(reader.width(), 33);
  EXPECT_EQ(reader.height(), 21);
  try {
    VideoWriter(folder.path() / "odd.mp4", 33, 21, 10.0);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("odd.mp4: .mp4 needs an even width and height, not 33 x 21"));
  }
}

// Oracle: the file's 24 frames at 12 a second.
TEST(Video, TheDeskVideoHasItsFramesAndTimes) {
  VideoReader reader = VideoReader::open_file(kVideo);
  EXPECT_EQ(reader.width(), 640);
  EXPECT_EQ(reader.height(), 480);
  EXPECT_EQ(reader.promised_frames(), 24);
  double last = -1.0;
  int count = 0;
  while (const auto frame = reader.next()) {
    EXPECT_GT(frame->time_s, last);
    EXPECT_NEAR(frame->time_s, count / 12.0, 1e-3);
    last = frame->time_s;
    ++count;
  }
  EXPECT_EQ(count, 24);
  EXPECT_EQ(reader.missing_frames(), 0);
}

// Oracle: half of the bytes hold about half of the 24 frames that the header promises.
TEST(Video, AVideoThatEndsEarlyEndsAndCountsWhatIsMissing) {
  const TemporaryFolder folder;
  const auto bytes = read_file(kVideo, 1 << 24);
  write_file(folder.path() / "half.avi",
             {reinterpret_cast<const char*>(bytes.data()), bytes.size() / 2});
  VideoReader reader = VideoReader::open_file(folder.path() / "half.avi");
  while (reader.next()) {
  }
  EXPECT_GE(reader.frames_read(), 10);
  EXPECT_LE(reader.frames_read(), 13);
  EXPECT_EQ(reader.missing_frames(), 24 - reader.frames_read());
  EXPECT_FALSE(reader.next());
}

TEST(Video, WhatIsNoVideoIsRefusedInOneLine) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of(folder.path() / "absent.avi"), HasSubstr("absent.avi: no such file"));
  EXPECT_THAT(message_of(folder.path()), HasSubstr("not a regular file"));
  write_file(folder.path() / "empty.avi", "");
  EXPECT_THAT(message_of(folder.path() / "empty.avi"), HasSubstr("empty.avi: cannot be opened"));
  write_file(folder.path() / "text.mp4", "this is no video, at all");
  EXPECT_THAT(message_of(folder.path() / "text.mp4"), HasSubstr("text.mp4: "));
  const auto bytes = read_file(kVideo, 1 << 24);
  for (const std::size_t length : {4, 12, 100, 300, 1000, 4000}) {
    write_file(folder.path() / "cut.avi", {reinterpret_cast<const char*>(bytes.data()), length});
    const std::string message = message_of(folder.path() / "cut.avi");
    EXPECT_THAT(message, HasSubstr("cut.avi: ")) << length;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

// Oracle: no crash and frames of one size; run under ASan and UBSan too.
TEST(Video, FlippedBytesNeverCrash) {
  const TemporaryFolder folder;
  const auto bytes = read_file(kVideo, 1 << 24);
  for (std::size_t at = 0; at < 320; at += 3) {
    std::string bad(bytes.begin(), bytes.begin() + 100000);
    bad[at] = static_cast<char>(~bad[at]);
    write_file(folder.path() / "bad.avi", bad);
    try {
      VideoReader reader = VideoReader::open_file(folder.path() / "bad.avi");
      for (int i = 0; i < 5; ++i)
        if (const auto frame = reader.next()) {
          EXPECT_EQ(frame->image.width, reader.width());
        }
    } catch (const InputError&) {
    }
  }
}

TEST(Video, ACameraThatIsNotThereIsRefused) {
  EXPECT_THROW(VideoReader::open_camera(-1), InputError);
  EXPECT_THROW(VideoReader::open_camera(97), InputError);
}

TEST(Video, AWriterThatIsNotClosedLeavesNothing) {
  const TemporaryFolder folder;
  {
    VideoWriter writer(folder.path() / "v.avi", 32, 32, 10.0);
    writer.write(frame_of(32, 32, 1));
  }
  EXPECT_EQ(files_in(folder.path()), 0);
  EXPECT_THROW(VideoWriter(folder.path() / "no/v.avi", 32, 32, 10.0), InputError);
  EXPECT_THROW(VideoWriter(folder.path() / "v.wmv", 32, 32, 10.0), InputError);
  VideoWriter empty(folder.path() / "v.avi", 32, 32, 10.0);
  EXPECT_THROW(empty.close(), InputError);
  EXPECT_FALSE(fs::exists(folder.path() / "v.avi"));
}

TEST(Video, MisuseNamesTheRule) {
  const TemporaryFolder folder;
  EXPECT_THROW(VideoWriter(folder.path() / "v.avi", 0, 32, 10.0), std::invalid_argument);
  VideoWriter writer(folder.path() / "v.avi", 32, 32, 10.0);
  EXPECT_THROW(writer.write(frame_of(16, 16, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace gnomon::ar
