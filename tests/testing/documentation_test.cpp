// docs/testing.md cannot rot: its example is the source that is compiled and run here, its failure
// what the example prints with the mistake that the page names. Oracle: the files and that program.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace {

std::string read(const std::string& path) {
  std::ifstream file(std::string(GNOMON_SOURCE_DIR) + "/" + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What stands between the first `begin` and the next `end`; nothing if they are not there.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t first = text.find(begin);
  if (first == std::string::npos) return {};
  const std::size_t start = first + begin.size(), stop = text.find(end, start);
  return stop == std::string::npos ? std::string() : text.substr(start, stop - start);
}

std::string output_of(const std::string& program) {
  std::FILE* pipe = popen(("'" + program + "' 2>&1").c_str(), "r");
  if (!pipe) return {};
  std::string output;
  std::array<char, 4096> part{};
  for (std::size_t n = 1; n > 0; output.append(part.data(), n))
    n = std::fread(part.data(), 1, part.size(), pipe);
  pclose(pipe);
  return output;
}

}  // namespace

TEST(Documentation, ShowsTheExampleThatIsCompiledAndRun) {
  const std::string example = read("tests/testing/example_test.cpp");
  EXPECT_EQ(between(read("docs/testing.md"), "```cpp\n", "```\n"), example);
  EXPECT_EQ(std::count(example.begin(), example.end(), '\n'), 25);
}

TEST(Documentation, ShowsWhatTheExamplePrintsWithItsMistake) {
  const std::string output = output_of(GNOMON_BUILD_DIR "/mistaken_example");
  const std::string failure = between(output, ": Failure\n", "\n[  FAILED  ]");
  EXPECT_NE(failure, "") << output;
  EXPECT_EQ(between(read("docs/testing.md"), "```text\n", "```\n"), failure);
}
