// The files behind read_camera. Keys as OpenCV, ROS (camera_info_manager's file and the message
// sensor_msgs/CameraInfo, ROS 1 and 2) and BoofCV write them.
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "ar/camera.h"
#include "ar/yaml_input.h"

namespace gnomon::ar {
namespace {

using std::filesystem::path;

constexpr int kMaxPictureSize = 65536;
constexpr double kMaxFocal = 1e7;
constexpr double kMaxCentre = 1e7;

struct Found {
  std::string key;
  YAML::Node node;
};

/// The first of these keys that the map has.
Found first_of(const YAML::Node& map, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (const YAML::Node node = map[key]; node.IsDefined() && !node.IsNull()) return {key, node};
  }
  return {*keys.begin(), YAML::Node(YAML::NodeType::Undefined)};
}

/// A matrix as {rows, cols, data} or as a bare list.
std::vector<double> matrix(const path& file, const Found& found, std::size_t max_count) {
  if (!found.node.IsMap()) return yaml::numbers(file, found.node, found.key, max_count);
  std::vector<double> data =
      yaml::numbers(file, found.node["data"], found.key + ".data", max_count);
  const int rows = yaml::integer(file, found.node["rows"], found.key + ".rows", 0, 64);
  const int cols = yaml::integer(file, found.node["cols"], found.key + ".cols", 0, 64);
  if (static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols) != data.size()) {
    yaml::fail(file, found.node, found.key,
               fmt::format("{} x {} values announced, {} found", rows, cols, data.size()));
  }
  return data;
}

void read_size(const path& file, const YAML::Node& map, CameraModel& camera) {
  const Found width = first_of(map, {"image_width", "width", "image_Width"});
  const Found height = first_of(map, {"image_height", "height", "image_Height"});
  if (!width.node.IsDefined() && !height.node.IsDefined()) return;
  camera.width = yaml::integer(file, width.node, width.key, 0, kMaxPictureSize);
  camera.height = yaml::integer(file, height.node, height.key, 0, kMaxPictureSize);
  if ((camera.width == 0) != (camera.height == 0)) {
    yaml::fail(file, width.node, width.key,
               fmt::format("{} x {} pixels is no picture", camera.width, camera.height));
  }
}

void check_focal(const path& file, const YAML::Node& node, const std::string& place,
                 const CameraModel& camera) {
  for (const double f : {camera.fx, camera.fy}) {
    if (!(f > 0.0 && f <= kMaxFocal)) {
      yaml::fail(file, node, place,
                 fmt::format("a focal length is above 0 and at most {:g} pixels, found {:g}",
                             kMaxFocal, f));
    }
  }
  for (const double c : {camera.cx, camera.cy}) {
    if (!(std::abs(c) <= kMaxCentre)) {
      yaml::fail(file, node, place,
                 fmt::format("a centre is within {:g} pixels, found {:g}", kMaxCentre, c));
    }
  }
}

void check_skew(const path& file, const YAML::Node& node, const std::string& place, double skew,
                double focal) {
  if (std::abs(skew) > 1e-6 * focal) {
    yaml::fail(file, node, place, fmt::format("skewed pixels are not supported, found {:g}", skew));
  }
}

void read_matrix(const path& file, const YAML::Node& root, CameraModel& camera) {
  const Found found =
      first_of(root, {"camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "k", "M1"});
  if (!found.node.IsDefined()) {
    throw InputError(fmt::format(
        "{}: camera_matrix: not found (read are OpenCV, ROS camera_info and BoofCV pinhole files)",
        file.string()));
  }
  const std::vector<double> k = matrix(file, found, 64);
  if (k.size() != 9) {
    yaml::fail(file, found.node, found.key, fmt::format("expected 9 values, found {}", k.size()));
  }
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  check_focal(file, found.node, found.key, camera);
  check_skew(file, found.node, found.key, k[1], k[0]);
  if (k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
    yaml::fail(file, found.node, found.key, "expected rows [fx 0 cx] [0 fy cy] [0 0 1]");
  }
}

void read_model_name(const path& file, const YAML::Node& root, CameraModel& camera) {
  if (const Found flag = first_of(root, {"fisheye_model"}); flag.node.IsDefined()) {
    if (yaml::integer(file, flag.node, flag.key, 0, 1) == 1) camera.lens = LensKind::fisheye;
  }
  const Found found = first_of(root, {"distortion_model"});
  if (!found.node.IsDefined()) return;
  const std::string name = yaml::text(file, found.node, found.key, 64);
  if (name == "equidistant" || name == "fisheye") {
    camera.lens = LensKind::fisheye;
  } else if (!name.empty() && name != "plumb_bob" && name != "rational_polynomial") {
    yaml::fail(file, found.node, found.key,
               "unknown model '" + name +
                   "' (known: plumb_bob, rational_polynomial, equidistant, fisheye)");
  }
}

void read_coefficients(const path& file, const YAML::Node& root, CameraModel& camera) {
  const Found found =
      first_of(root, {"distortion_coefficients", "Distortion_Coefficients",
                      "distortionCoefficients", "distCoeffs", "dist_coeffs", "D", "d", "D1"});
  if (!found.node.IsDefined()) return;
  camera.distortion = matrix(file, found, 64);
  const std::size_t n = camera.distortion.size();
  if (camera.lens == LensKind::fisheye) {
    if (n != 0 && n != 4) {
      yaml::fail(file, found.node, found.key,
                 fmt::format("a fisheye lens has 0 or 4 coefficients, found {}", n));
    }
  } else if (n != 0 && n != 4 && n != 5 && n != 8 && n != 12 && n != 14) {
    yaml::fail(file, found.node, found.key,
               fmt::format("a lens has 0, 4, 5, 8, 12 or 14 coefficients, found {}", n));
  }
}

CameraModel read_boofcv(const path& file, const YAML::Node& root) {
  const YAML::Node pinhole = root["pinhole"];
  if (!pinhole.IsMap()) yaml::fail(file, pinhole, "pinhole", "expected a map");
  CameraModel camera;
  read_size(file, pinhole, camera);
  camera.fx = yaml::number(file, pinhole["fx"], "pinhole.fx");
  camera.fy = yaml::number(file, pinhole["fy"], "pinhole.fy");
  camera.cx = yaml::number(file, pinhole["cx"], "pinhole.cx");
  camera.cy = yaml::number(file, pinhole["cy"], "pinhole.cy");
  check_focal(file, pinhole, "pinhole", camera);
  if (const YAML::Node skew = pinhole["skew"]; skew.IsDefined()) {
    check_skew(file, skew, "pinhole.skew", yaml::number(file, skew, "pinhole.skew"), camera.fx);
  }
  if (const YAML::Node model = root["model"]; model.IsDefined()) {
    const std::string name = yaml::text(file, model, "model", 64);
    if (name != "pinhole" && name != "pinhole_radial_tangential") {
      yaml::fail(file, model, "model",
                 "unknown model '" + name + "' (known: pinhole, pinhole_radial_tangential)");
    }
  }
  const YAML::Node lens = root["radial_tangential"];
  if (!lens.IsDefined() || lens.IsNull()) return camera;
  if (!lens.IsMap()) yaml::fail(file, lens, "radial_tangential", "expected a map");
  std::vector<double> k;
  if (const YAML::Node radial = lens["radial"]; radial.IsDefined() && !radial.IsNull()) {
    k = yaml::numbers(file, radial, "radial_tangential.radial", 3);
  }
  k.resize(3, 0.0);
  const auto optional_number = [&](const char* key) {
    const YAML::Node node = lens[key];
    return node.IsDefined() ? yaml::number(file, node, std::string("radial_tangential.") + key)
                            : 0.0;
  };
  camera.distortion = {k[0], k[1], optional_number("t1"), optional_number("t2"), k[2]};
  return camera;
}

}  // namespace

CameraModel read_camera(const path& file) {
  const YAML::Node root = yaml::load(file);
  if (root["pinhole"].IsDefined()) return read_boofcv(file, root);
  CameraModel camera;
  read_size(file, root, camera);
  read_matrix(file, root, camera);
  read_model_name(file, root, camera);
  read_coefficients(file, root, camera);
  return camera;
}

}  // namespace gnomon::ar
