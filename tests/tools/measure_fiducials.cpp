// Detections in real photographs against what is known to be there.
// Usage: measure_fiducials DIR   where DIR has apriltag_nasa, swatbotics_room, opencv_aruco,
// boofcv_aruco25h7 and duckietown, each as its project published it. Prints what was expected,
// found, missed and false; corners against the expected ones; and false detections of every other
// family on the same photographs.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "ar/image_file.h"
#include "ar/tags.h"
#include "statistics.h"

namespace gnomon::ar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

using Ids = std::vector<int>;

struct Expected {
  fs::path picture;
  std::string family;
  /// Sorted; absent when nobody has counted.
  std::optional<Ids> ids;
  /// Corners as known, in any order of the four.
  std::vector<std::pair<int, TagCorners>> corners;
};

TagCorners corners_of(const json& eight) {
  TagCorners c;
  for (std::size_t i = 0; i < 4; ++i)
    c[i] = {eight[2 * i].get<double>(), eight[2 * i + 1].get<double>()};
  return c;
}

Ids range(int n) {
  Ids ids(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) ids[static_cast<std::size_t>(i)] = i;
  return ids;
}

/// Lines "id, (x y), (x y), (x y), (x y)" in AprilTag's pixels.
std::vector<Expected> nasa(const fs::path& dir) {
  std::vector<Expected> all;
  std::set<fs::path> files;
  for (const auto& e : fs::directory_iterator(dir)) {
    if (e.path().extension() == ".txt") files.insert(e.path());
  }
  for (const fs::path& file : files) {
    Expected expected{fs::path(file).replace_extension(".jpg"), "tag36h11", Ids{}, {}};
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      for (char& c : line) {
        if (c == ',' || c == '(' || c == ')') c = ' ';
      }
      std::istringstream numbers(line);
      int id = 0;
      TagCorners c;
      if (!(numbers >> id)) continue;
      for (glm::dvec2& p : c) numbers >> p.x >> p.y;
      for (glm::dvec2& p : c) p -= 0.5;
      expected.ids->push_back(id);
      expected.corners.emplace_back(id, c);
    }
    std::sort(expected.ids->begin(), expected.ids->end());
    all.push_back(expected);
  }
  return all;
}

std::vector<Expected> room(const fs::path& dir) {
  std::vector<Expected> all;
  std::ifstream in(dir / "groundtruth.txt");
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string name;
    words >> name;
    Ids ids;
    for (int id = 0; words >> id;) ids.push_back(id);
    std::sort(ids.begin(), ids.end());
    if (fs::exists(dir / "images" / name)) {
      all.push_back({dir / "images" / name, "tag36h11", ids, {}});
    }
  }
  return all;
}

std::vector<Expected> aruco(const fs::path& dir) {
  std::ifstream in(dir / "expected_corners.json");
  const json truth = json::parse(in);
  Expected single{dir / "singlemarkersoriginal.jpg", "DICT_6X6_250", Ids{}, {}};
  for (const auto& [key, value] : truth.at("singlemarkersoriginal.jpg").items()) {
    if (key.find_first_not_of("0123456789") != std::string::npos) continue;
    single.ids->push_back(std::stoi(key));
    single.corners.emplace_back(std::stoi(key), corners_of(value));
  }
  std::sort(single.ids->begin(), single.ids->end());
  const json& board = truth.at("gboriginal.png");
  const Ids diamonds = truth.at("diamondmarkers.png").at("marker_ids").get<Ids>();
  Ids sorted = diamonds;
  std::sort(sorted.begin(), sorted.end());
  return {single,
          {dir / "choriginal.jpg", "DICT_6X6_250", range(17), {}},
          {dir / "chocclusion_original.jpg",
           "DICT_6X6_250",
           truth.at("chocclusion_original.jpg").at("ids").get<Ids>(),
           {}},
          {dir / "gboriginal.png",
           "tutorial_dict",
           range(35),
           {{0, corners_of(board.at("first"))}, {34, corners_of(board.at("last"))}}},
          {dir / "diamondmarkers.png", "tutorial_dict", sorted, {}}};
}

std::vector<Expected> uncounted(const fs::path& dir, const std::string& family) {
  std::set<fs::path> files;
  for (const auto& e : fs::directory_iterator(dir)) {
    if (e.path().extension() == ".jpg" || e.path().extension() == ".png") files.insert(e.path());
  }
  std::vector<Expected> all;
  for (const fs::path& file : files) all.push_back({file, family, std::nullopt, {}});
  return all;
}

/// The farthest corner, each measured to the nearest found one of its tag.
void compare_corners(const Expected& expected, const std::vector<Detection>& found,
                     Statistics& errors) {
  for (const auto& [id, corners] : expected.corners) {
    std::optional<double> best;
    for (const Detection& d : found) {
      if (d.id.number != id) continue;
      double worst = 0.0;
      for (const glm::dvec2& p : corners) {
        double nearest = 1e9;
        for (const glm::dvec2& q : d.corners_px) nearest = std::min(nearest, glm::distance(p, q));
        worst = std::max(worst, nearest);
      }
      if (!best || worst < *best) best = worst;
    }
    if (best) errors.add(*best);
  }
}

void print_set(const std::string& name, const std::vector<Expected>& pictures,
               const std::vector<CustomDictionary>& dictionaries,
               const TagDetectorOptions& options) {
  std::size_t wanted = 0, found = 0, right = 0;
  Statistics corners;
  std::map<std::string, int> uncounted_ids;
  for (const Expected& expected : pictures) {
    TagDetector detector({expected.family}, dictionaries, options);
    const std::vector<Detection> detections = detector.detect(read_image(expected.picture));
    Ids ids;
    for (const Detection& d : detections) ids.push_back(d.id.number);
    std::sort(ids.begin(), ids.end());
    found += ids.size();
    if (!expected.ids) {
      fmt::print("  {}: {}\n", expected.picture.filename().string(), fmt::join(ids, " "));
      continue;
    }
    Ids both, missed, wrong;
    std::set_intersection(ids.begin(), ids.end(), expected.ids->begin(), expected.ids->end(),
                          std::back_inserter(both));
    std::set_difference(expected.ids->begin(), expected.ids->end(), ids.begin(), ids.end(),
                        std::back_inserter(missed));
    std::set_difference(ids.begin(), ids.end(), expected.ids->begin(), expected.ids->end(),
                        std::back_inserter(wrong));
    if (!missed.empty() || !wrong.empty()) {
      fmt::print("  {}: missed {} not expected {}\n", expected.picture.filename().string(), missed,
                 wrong);
    }
    wanted += expected.ids->size();
    right += both.size();
    compare_corners(expected, detections, corners);
  }
  fmt::print("{}: {} pictures, expected {}, found {}, right {}; corners off px {}\n", name,
             pictures.size(), wanted, found, right, corners.text());
}

/// Every family on photographs that show none of its tags.
void print_false(const std::vector<std::vector<Expected>>& sets,
                 const TagDetectorOptions& options) {
  for (const std::string& family : known_families()) {
    TagDetector detector({family}, {}, options);
    int count = 0, pictures = 0;
    Statistics margins;
    for (const auto& set : sets) {
      for (const Expected& expected : set) {
        // The same codes under OpenCV's name.
        if (expected.family == family || family.starts_with("DICT_6X6") ||
            (expected.family == "tag36h11" && family == "DICT_APRILTAG_36h11")) {
          continue;
        }
        ++pictures;
        for (const Detection& d : detector.detect(read_image(expected.picture))) {
          ++count;
          margins.add(d.margin);
        }
      }
    }
    fmt::print("{}: {} false in {} pictures; margin {}\n", family, count, pictures, margins.text());
  }
}

}  // namespace

void measure_fiducials(const fs::path& dir) {
  const std::vector<CustomDictionary> dictionaries{
      {"tutorial_dict", dir / "opencv_aruco/tutorial_dict.yml"},
      {"aruco_mip_25h7", dir / "boofcv_aruco25h7/aruco_mip_25h7_opencv_dict.yml"}};
  const std::vector<std::vector<Expected>> sets{
      nasa(dir / "apriltag_nasa"), room(dir / "swatbotics_room"), aruco(dir / "opencv_aruco"),
      uncounted(dir / "boofcv_aruco25h7", "aruco_mip_25h7"),
      uncounted(dir / "duckietown", "tag36h11")};
  const char* names[] = {"apriltag_nasa", "swatbotics_room", "opencv_aruco", "boofcv_aruco25h7",
                         "duckietown"};
  for (const bool refine : {false, true}) {
    TagDetectorOptions options;
    options.refine = refine;
    fmt::print("{}\n",
               refine ? "Lines fitted to edges, gamma 2.2:" : "The detectors' own corners:");
    for (std::size_t i = 0; i < sets.size(); ++i)
      print_set(names[i], sets[i], dictionaries, options);
  }
  fmt::print("False detections of families that are not in the pictures, default limits:\n");
  print_false(sets, {});
  TagDetectorOptions lax;
  lax.max_hamming = 2;
  lax.min_margin = 0.0;
  fmt::print("The same without limits:\n");
  print_false(sets, lax);
}

}  // namespace gnomon::ar

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i) gnomon::ar::measure_fiducials(argv[i]);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
