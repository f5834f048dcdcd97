#include "ar/tag_families.h"

#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>

#include <algorithm>
#include <bitset>

#include <fmt/format.h>

#include "ar/yaml_input.h"

namespace gnomon::ar {
namespace {

struct AprilEntry {
  const char* name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

constexpr AprilEntry kAprilFamilies[] = {
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag36h10", tag36h10_create, tag36h10_destroy},
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
};

struct ArucoEntry {
  const char* name;
  cv::aruco::PREDEFINED_DICTIONARY_NAME value;
};

constexpr ArucoEntry kArucoDictionaries[] = {
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    {"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
    {"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
    {"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11},
};

cv::Mat marker_bits(const std::filesystem::path& file, const YAML::Node& node,
                    const std::string& key, int size) {
  const std::size_t count = static_cast<std::size_t>(size) * size;
  const std::string digits = yaml::text(file, node, key, 256);
  if (digits.size() != count || digits.find_first_not_of("01") != std::string::npos) {
    yaml::fail(file, node, key,
               fmt::format("expected {} digits 0 and 1, found '{:.40}'", count, digits));
  }
  cv::Mat bits(size, size, CV_8UC1);
  for (std::size_t i = 0; i < count; ++i) {
    bits.at<std::uint8_t>(static_cast<int>(i) / size, static_cast<int>(i) % size) =
        digits[i] == '1' ? 1 : 0;
  }
  return bits;
}

using Bits = std::bitset<100>;

/// The code as it reads when the marker is turned by a quarter.
Bits quarter_turn(const Bits& bits, int size) {
  Bits turned;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      turned[static_cast<std::size_t>(x * size + size - 1 - y)] =
          bits[static_cast<std::size_t>(y * size + x)];
    }
  }
  return turned;
}

/// Bits that can be corrected with certainty: less than half the smallest distance between two
/// codes in any of the four turns.
int correctable_bits(const std::vector<Bits>& codes, int size) {
  std::size_t smallest = static_cast<std::size_t>(size) * size;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    Bits turned = codes[i];
    for (int turn = 0; turn < 4; ++turn, turned = quarter_turn(turned, size)) {
      if (turn > 0) smallest = std::min(smallest, (turned ^ codes[i]).count());
      for (std::size_t j = i + 1; j < codes.size(); ++j) {
        smallest = std::min(smallest, (turned ^ codes[j]).count());
      }
    }
  }
  return smallest == 0 ? 0 : static_cast<int>((smallest - 1) / 2);
}

}  // namespace

std::vector<std::string> april_family_names() {
  std::vector<std::string> names;
  for (const AprilEntry& entry : kAprilFamilies) names.emplace_back(entry.name);
  return names;
}

std::vector<std::string> aruco_dictionary_names() {
  std::vector<std::string> names;
  for (const ArucoEntry& entry : kArucoDictionaries) names.emplace_back(entry.name);
  return names;
}

AprilFamilyPtr make_april_family(const std::string& name) {
  for (const AprilEntry& entry : kAprilFamilies) {
    if (name == entry.name) return {entry.create(), entry.destroy};
  }
  return {nullptr, [](apriltag_family_t*) {}};
}

cv::Ptr<cv::aruco::Dictionary> predefined_dictionary(const std::string& name) {
  for (const ArucoEntry& entry : kArucoDictionaries) {
    if (name == entry.name) return cv::aruco::getPredefinedDictionary(entry.value);
  }
  return {};
}

cv::Ptr<cv::aruco::Dictionary> read_dictionary(const std::filesystem::path& file) {
  const YAML::Node root = yaml::load(file);
  const int markers = yaml::integer(file, root["nmarkers"], "nmarkers", 1, 4096);
  const int size = yaml::integer(file, root["markersize"], "markersize", 3, 10);
  cv::Mat bytes;
  std::vector<Bits> codes;
  for (int i = 0; i < markers; ++i) {
    const std::string key = fmt::format("marker_{}", i);
    const cv::Mat bits = marker_bits(file, root[key], key, size);
    bytes.push_back(cv::aruco::Dictionary::getByteListFromBits(bits));
    Bits code;
    for (int b = 0; b < size * size; ++b) {
      code[static_cast<std::size_t>(b)] = bits.at<std::uint8_t>(b / size, b % size) != 0;
    }
    codes.push_back(code);
  }
  const YAML::Node correction = root["maxCorrectionBits"];
  const int corrected = correction.IsDefined()
                            ? yaml::integer(file, correction, "maxCorrectionBits", 0, size * size)
                            : correctable_bits(codes, size);
  return cv::makePtr<cv::aruco::Dictionary>(bytes, size, corrected);
}

}  // namespace gnomon::ar
