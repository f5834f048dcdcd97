// The layers of the project: raster <- pipeline <- ar <- apps, tests, bench; raster <-
// tests/testing, the library for the tests of others. Oracle: the includes that the sources
// themselves hold, against the rules written here.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

struct Rule {
  std::vector<std::string> folders;
  /// First parts of the bracketed includes a folder may have besides the standard library's.
  std::vector<std::string> libraries;
};

/// Folders that are libraries; what may not be seen above them is the point of the test.
const std::map<std::string, Rule>& rules() {
  static const std::map<std::string, Rule> kRules{
      {"raster", {{"raster"}, {"glm", "hwy", "tbb", "oneapi", "sanitizer", "wasm_simd128.h"}}},
      {"pipeline",
       {{"raster", "pipeline"}, {"glm", "hwy", "tbb", "oneapi", "embree3", "meshoptimizer.h"}}},
      {"golden", {{"raster", "golden"}, {"glm", "nlohmann"}}},
      {"tests/testing", {{"raster", "testing"}, {"glm", "gmock", "gtest", "raster", "testing"}}},
  };
  return kRules;
}

bool contains(const std::vector<std::string>& list, const std::string& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// The standard library's headers have neither a folder nor an ending; the few of C that POSIX adds
/// are nobody's business in a layer that knows no file.
bool is_standard(const std::string& header) {
  return header.find('/') == std::string::npos && header.find('.') == std::string::npos;
}

/// One line "file includes header" for each include that breaks a rule below `root`.
std::vector<std::string> violations(const fs::path& root) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  std::vector<std::string> found;
  for (const auto& folder : {"raster", "pipeline", "ar", "golden", "tests/testing"}) {
    if (!fs::exists(root / folder)) continue;
    const auto rule = rules().find(folder);
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream file(entry.path());
      std::string line;
      std::smatch match;
      while (std::getline(file, line)) {
        if (!std::regex_search(line, match, kInclude)) continue;
        const std::string header = match[2], top = header.substr(0, header.find('/'));
        const bool own = match[1] == "\"";
        bool allowed = true;
        if (own) {
          allowed = header.find('/') != std::string::npos &&
                    (rule == rules().end() ? contains({"raster", "pipeline", "ar"}, top)
                                           : contains(rule->second.folders, top));
        } else if (rule != rules().end()) {
          allowed = is_standard(header) || contains(rule->second.libraries, top);
        }
        if (!allowed) {
          found.push_back(fs::relative(entry.path(), root).generic_string() + " includes " +
                          header);
        }
      }
    }
  }
  return found;
}

TEST(Layers, IncludesGoFromArToPipelineToRasterOnly) {
  ASSERT_TRUE(fs::exists(fs::path(GNOMON_SOURCE_DIR) / "raster/frame.h"));
  EXPECT_THAT(violations(GNOMON_SOURCE_DIR), IsEmpty());
}

TEST(Layers, EveryKindOfWrongIncludeIsFound) {
  const fs::path root = fs::path(GNOMON_BUILD_DIR) / "layers_test";
  fs::remove_all(root);
  const auto write = [&](const char* path, const char* text) {
    fs::create_directories((root / path).parent_path());
    std::ofstream(root / path) << text;
  };
  write("raster/good.cpp", "#include <vector>\n#include <glm/vec3.hpp>\n#include \"raster/a.h\"\n");
  write("raster/up.h", "#include \"pipeline/scene.h\"\n");
  write("raster/file.cpp", "  # include <opencv2/core.hpp>\n");
  write("pipeline/good.cpp", "#include <embree3/rtcore.h>\n#include \"raster/a.h\"\n");
  write("pipeline/up.cpp", "#include \"ar/image.h\"\n");
  write("ar/good.cpp", "#include <opencv2/core.hpp>\n#include \"pipeline/scene.h\"\n");
  write("ar/up.cpp", "#include \"apps/commands.h\"\n");
  write("ar/not_from_the_root.cpp", "#include \"image.h\"\n");
  write("golden/up.cpp", "#include <nlohmann/json.hpp>\n#include \"ar/image.h\"\n");
  write("tests/testing/good.h", "#include <gmock/gmock.h>\n#include \"raster/a.h\"\n");
  write("tests/testing/up.cpp", "#include \"pipeline/scene.h\"\n");
  EXPECT_THAT(
      violations(root),
      UnorderedElementsAre(
          "raster/up.h includes pipeline/scene.h", "raster/file.cpp includes opencv2/core.hpp",
          "pipeline/up.cpp includes ar/image.h", "ar/up.cpp includes apps/commands.h",
          "ar/not_from_the_root.cpp includes image.h", "golden/up.cpp includes ar/image.h",
          "tests/testing/up.cpp includes pipeline/scene.h"));
  fs::remove_all(root);
}

}  // namespace
