#include "ar/tags.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ar/error.h"
#include "ar/refine.h"
#include "ar/tag_families.h"
#include "raster/check.h"

namespace gnomon::ar {
namespace {

/// libapriltag 3.3.0 reads outside pictures of a few pixels; no tag fits into these either.
constexpr int kSmallestPicture_px = 16;
/// With two corrected bits a family of 65535 codes wants 7 GB of tables.
constexpr std::uint32_t kManyCodes = 5000;
/// Families with a smaller distance between codes read noise as tags when bits are corrected.
constexpr std::uint32_t kSafeDistance = 9;
constexpr int kSafeArucoBits = 3;
/// Of OpenCV's: wrong bits in the black border, as a share of a marker's bits. Its 0.35 lets
/// through squares that are hardly a border; no marker of the measured photographs needs more than
/// this.
constexpr double kArucoBorderErrors = 0.1;
constexpr double kArucoCorrectionRate = 0.6;

struct DetectorDeleter {
  void operator()(apriltag_detector_t* d) const { apriltag_detector_destroy(d); }
};
struct DetectionsDeleter {
  void operator()(zarray_t* d) const { apriltag_detections_destroy(d); }
};

struct Dictionary {
  std::string name;
  cv::Ptr<cv::aruco::Dictionary> codes;
};

auto place_of(const Detection& d) { return std::tuple(d.id, d.corners_px[0].x, d.corners_px[0].y); }

}  // namespace

struct TagDetector::Impl {
  TagDetectorOptions options;
  std::vector<AprilFamilyPtr> families;
  std::unique_ptr<apriltag_detector_t, DetectorDeleter> april;
  std::vector<Dictionary> dictionaries;

  void add_april(AprilFamilyPtr family);
  void detect_april(const Image& picture, std::vector<Detection>& found,
                    std::vector<SquareLook>& looks) const;
  void detect_aruco(const Image& picture, const Dictionary& dictionary,
                    std::vector<Detection>& found, std::vector<SquareLook>& looks) const;
};

void TagDetector::Impl::add_april(AprilFamilyPtr family) {
  if (!april) {
    april.reset(apriltag_detector_create());
    // More threads race inside the library (AprilRobotics/apriltag#387).
    april->nthreads = 1;
    april->quad_decimate = static_cast<float>(options.decimate);
    april->quad_sigma = 0.0f;
    // Our own lines take its place; moving corners before decoding loses tags.
    april->refine_edges = !options.refine || options.decimate > 1.0;
  }
  const int safe = family->h >= kSafeDistance ? 2 : 0;
  const int bits =
      std::min(options.max_hamming.value_or(safe), family->ncodes > kManyCodes ? 1 : 2);
  apriltag_detector_add_family_bits(april.get(), family.get(), bits);
  families.push_back(std::move(family));
}

void TagDetector::Impl::detect_april(const Image& picture, std::vector<Detection>& found,
                                     std::vector<SquareLook>& looks) const {
  Image copy = picture;
  image_u8_t view{picture.width, picture.height, picture.width, copy.pixels.data()};
  const std::unique_ptr<zarray_t, DetectionsDeleter> all(
      apriltag_detector_detect(april.get(), &view));
  for (int i = 0; i < zarray_size(all.get()); ++i) {
    apriltag_detection_t* d = nullptr;
    zarray_get(all.get(), i, &d);
    if (d->decision_margin < options.min_margin) continue;
    Detection detection{{d->family->name, d->id}, {}, d->hamming, d->decision_margin};
    // AprilTag counts from the bottom left, counter-clockwise as printed.
    for (std::size_t c = 0; c < 4; ++c) {
      detection.corners_px[c] = {d->p[3 - c][0] - 0.5, d->p[3 - c][1] - 0.5};
    }
    found.push_back(detection);
    looks.push_back({d->family->width_at_border, d->family->reversed_border});
  }
}

void TagDetector::Impl::detect_aruco(const Image& picture, const Dictionary& dictionary,
                                     std::vector<Detection>& found,
                                     std::vector<SquareLook>& looks) const {
  const cv::Mat view(picture.height, picture.width, CV_8UC1,
                     const_cast<std::uint8_t*>(picture.pixels.data()));
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_CONTOUR;
  parameters->maxErroneousBitsInBorderRate = kArucoBorderErrors;
  const int correctable = dictionary.codes->maxCorrectionBits;
  const double safe = correctable >= kSafeArucoBits ? kArucoCorrectionRate : 0.0;
  // OpenCV truncates rate x correctable to whole bits.
  parameters->errorCorrectionRate = options.max_hamming && correctable > 0
                                        ? std::min(1.0, (*options.max_hamming + 0.01) / correctable)
                                        : safe;
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> numbers;
  cv::aruco::detectMarkers(view, dictionary.codes, corners, numbers, parameters);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    Detection detection{{dictionary.name, numbers[i]}, {}};
    for (std::size_t c = 0; c < 4; ++c) {
      detection.corners_px[c] = {corners[i][c].x, corners[i][c].y};
    }
    found.push_back(detection);
    looks.push_back({dictionary.codes->markerSize + 2, false});
  }
}

std::vector<std::string> known_families() {
  std::vector<std::string> names = april_family_names();
  for (std::string& name : aruco_dictionary_names()) names.push_back(std::move(name));
  return names;
}

std::array<glm::dvec3, 4> tag_corners_m(double size_m) {
  const double s = 0.5 * size_m;
  return {glm::dvec3(-s, s, 0), {s, s, 0}, {s, -s, 0}, {-s, -s, 0}};
}

TagDetector::TagDetector(const std::vector<std::string>& families,
                         const std::vector<CustomDictionary>& dictionaries,
                         TagDetectorOptions options)
    : impl_(std::make_unique<Impl>()) {
  raster::require(options.decimate >= 1.0 && options.decimate <= 16.0,
                  "tags are looked for in a picture 1 to 16 times smaller");
  raster::require(!options.max_hamming || (*options.max_hamming >= 0 && *options.max_hamming <= 2),
                  "a tag detector corrects 0 to 2 bits");
  impl_->options = std::move(options);
  for (const std::string& name : std::set<std::string>(families.begin(), families.end())) {
    const auto custom = std::find_if(dictionaries.begin(), dictionaries.end(),
                                     [&](const CustomDictionary& d) { return d.name == name; });
    if (custom != dictionaries.end()) {
      impl_->dictionaries.push_back({name, read_dictionary(custom->file)});
    } else if (auto codes = predefined_dictionary(name)) {
      impl_->dictionaries.push_back({name, codes});
    } else if (auto family = make_april_family(name)) {
      impl_->add_april(std::move(family));
    } else {
      std::vector<std::string> known = known_families();
      for (const CustomDictionary& d : dictionaries) known.push_back(d.name);
      throw InputError(
          fmt::format("tag family '{:.60}': not known (known: {})", name, fmt::join(known, ", ")));
    }
  }
}

TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<Detection> TagDetector::detect(const Image& picture, const Lens* lens) {
  const Image values = grey(picture);
  std::vector<Detection> found;
  if (std::min(values.width, values.height) < kSmallestPicture_px * impl_->options.decimate) {
    return found;
  }
  std::vector<SquareLook> looks;
  if (impl_->april) impl_->detect_april(values, found, looks);
  for (const Dictionary& d : impl_->dictionaries) impl_->detect_aruco(values, d, found, looks);
  if (impl_->options.refine && !found.empty()) {
    const LightPlane light = linear_light(picture, impl_->options.response);
    for (std::size_t i = 0; i < found.size(); ++i) {
      found[i].corners_px = refine_corners(light, found[i].corners_px, looks[i], lens);
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Detection& a, const Detection& b) {
    return place_of(a) < place_of(b);
  });
  return found;
}

}  // namespace gnomon::ar
