// The families behind TagDetector: libapriltag's by name, OpenCV's ArUco dictionaries by name or
// from a file. Internal to ar/: shows both libraries.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <apriltag/apriltag.h>
#include <opencv2/aruco.hpp>

namespace gnomon::ar {

using AprilFamilyPtr = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;

std::vector<std::string> april_family_names();
std::vector<std::string> aruco_dictionary_names();

/// Null for a name that libapriltag does not have.
AprilFamilyPtr make_april_family(const std::string& name);

/// Null for a name that OpenCV does not have.
cv::Ptr<cv::aruco::Dictionary> predefined_dictionary(const std::string& name);

/// Reads nmarkers, markersize, maxCorrectionBits and marker_0 ... as OpenCV writes them. Without
/// maxCorrectionBits as many are corrected as the codes' smallest distance allows.
/// Errors: InputError for a count over 4096, a size not in [3, 10], a marker that is missing or not
/// of size x size digits 0 and 1.
cv::Ptr<cv::aruco::Dictionary> read_dictionary(const std::filesystem::path& file);

}  // namespace gnomon::ar
