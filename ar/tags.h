// Finds square tags in pictures: the AprilTag families of libapriltag and OpenCV's ArUco
// dictionaries, predefined or from a file.
// Conventions, the same for all: pixels with the first pixel's centre at (0, 0) (OpenCV; AprilTag's
// own corners less 0.5); corners as printed in the order top left, top right, bottom right, bottom
// left, i.e. (-s, s), (s, s), (s, -s), (-s, -s) of the tag's frame with s half its size.
// Sources: Olson 2011, Wang and Olson 2016 (AprilTag); Garrido-Jurado et al. 2014 (ArUco).
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ar/camera.h"
#include "ar/image.h"
#include "ar/response.h"
#include "ar/tag_layout.h"

namespace gnomon::ar {

using TagCorners = std::array<glm::dvec2, 4>;

struct Detection {
  TagId id;
  TagCorners corners_px{};
  /// Bits that were corrected (0 for ArUco, which does not say).
  int hamming = 0;
  /// AprilTag's decision margin; 255 for ArUco.
  double margin = 255.0;
};

/// A dictionary in the form of OpenCV's Dictionary::readDictionary, known by `name`.
struct CustomDictionary {
  std::string name;
  std::filesystem::path file;
};

struct TagDetectorOptions {
  /// AprilTag looks for squares in a picture this many times smaller.
  double decimate = 1.0;
  /// Corners from lines fitted to the four edges in linear light (refine.h); off: the detector's
  /// own.
  bool refine = true;
  /// Turns values into light for the refinement.
  Response response = Response::from_gamma(2.2);
  /// Corrected bits that are accepted, 0 to 2. Absent: 2 for families whose codes differ in 9 bits
  /// or more, else 0 (ArUco: OpenCV's own rate where a dictionary can correct 3 bits, else 0),
  /// which gave no false AprilTag on real photographs (docs/tracking.md).
  std::optional<int> max_hamming = {};
  /// AprilTag's smallest decision margin.
  double min_margin = 0.0;
};

/// Names that TagDetector knows without a file.
std::vector<std::string> known_families();

/// The corners of a tag in its own frame, in the order above.
std::array<glm::dvec3, 4> tag_corners_m(double size_m);

/// Not for use by two threads at once.
class TagDetector {
 public:
  /// Errors: InputError naming a family that is neither known nor in `dictionaries`, or what is
  /// wrong with a dictionary's file.
  explicit TagDetector(const std::vector<std::string>& families,
                       const std::vector<CustomDictionary>& dictionaries = {},
                       TagDetectorOptions options = {});
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// Tags of all families, sorted by family, number and place. The same number may appear more than
  /// once if the picture shows it so. Pictures too small for a tag have none.
  /// With a lens, edges are fitted along the curves that it makes of straight lines.
  std::vector<Detection> detect(const Image& picture, const Lens* lens = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon::ar
