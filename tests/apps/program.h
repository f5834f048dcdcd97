// The built program as a test fixture: runs it in a folder of its own and catches status and both
// streams.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ar/image_file.h"

namespace gnomon {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;
  std::string out, err;
};

inline std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline std::string quoted(const std::string& argument) { return "'" + argument + "'"; }

class Program : public testing::Test {
 protected:
  Program()
      : folder_(fs::path(GNOMON_BUILD_DIR) / "cli_test" /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Program() override { fs::remove_all(folder_); }

  Outcome run(const std::vector<std::string>& arguments) const {
    std::string command = quoted(GNOMON_PROGRAM);
    for (const std::string& argument : arguments) command += " " + quoted(argument);
    command += " >" + quoted(file("stdout")) + " 2>" + quoted(file("stderr")) + " </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(file("stdout")),
            text_of(file("stderr"))};
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  std::string write_picture(const std::string& name, int width, int height, int channels,
                            std::uint8_t value) const {
    ar::Image image{width, height, channels, {}};
    image.pixels.assign(static_cast<std::size_t>(width) * height * channels, value);
    ar::write_png(file(name), image);
    return file(name);
  }

  /// A failed run prints nothing but one line on the error stream, and ends with 1.
  static void expect_one_line_error(const Outcome& run, const std::string& part) {
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.err, testing::StartsWith("gnomon: "));
    EXPECT_THAT(run.err, testing::HasSubstr(part));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }

 private:
  fs::path folder_;
};

}  // namespace gnomon
