// Errors of tag corners and poses against the ground truth of a capture set.
// Usage: measure_captures DIR...   where DIR has background.png, camera_pose.json,
// truth/*/photo.png, perhaps video/ with poses.json and response.json, and DIR/.. has camera.yml
// and tags.json.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "ar/image_file.h"
#include "ar/tracker.h"
#include "capture_json.h"
#include "statistics.h"

namespace gnomon::ar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kFlip_deg = 5.0;

struct Picture {
  Image image;
  glm::dmat4 world_from_camera{1.0};
  std::optional<glm::dmat4> world_from_handle;
};

struct Capture {
  CameraModel camera;
  /// World tags; a body for each tag that is fixed to something else.
  TagLayout layout;
  std::map<std::string, glm::dmat4> world_from_body;
  std::vector<Picture> background, truth, video;
  std::optional<fs::path> response;
  double video_fps = 12.0;
};

constexpr const char* kHandle = "handle";

void read_layout(const json& tags, const std::string& variant, Capture& capture) {
  for (const json& tag : tags.at("tags")) {
    const auto variants = tag.at("variants").get<std::vector<std::string>>();
    if (std::find(variants.begin(), variants.end(), variant) == variants.end()) continue;
    const TagId id{tags.at("family").get<std::string>(), tag.at("id").get<int>()};
    const std::string body = tag.at("attached_to").get<std::string>();
    const double size_m = tag.at("size").get<double>();
    if (body.starts_with("world")) {
      capture.layout.world.tags.push_back({id, size_m, matrix_of(tag.at("world_from_tag"))});
    } else {
      capture.layout.bodies.push_back({body, {{id, size_m}}});
      if (body != kHandle) capture.world_from_body[body] = matrix_of(tag.at("world_from_tag"));
    }
  }
}

Capture read_capture(const fs::path& dir) {
  Capture capture;
  capture.camera = read_camera(dir / "../camera.yml");
  read_layout(load_json(dir / "../tags.json"), dir.filename().string(), capture);
  const glm::dmat4 still =
      matrix_of(load_json(dir / "camera_pose.json").at("world_from_camera_opencv"));
  capture.background.push_back({read_image(dir / "background.png"), still, {}});
  std::set<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(dir / "truth")) folders.insert(entry.path());
  for (const fs::path& folder : folders) {
    capture.truth.push_back({read_image(folder / "photo.png"), still, {}});
  }
  if (fs::exists(dir / "video/poses.json")) {
    const json poses = load_json(dir / "video/poses.json");
    capture.video_fps = poses.at("fps").get<double>();
    for (const json& frame : poses.at("frames")) {
      capture.video.push_back({read_image(dir / "video" / frame.at("file").get<std::string>()),
                               matrix_of(frame.at("world_from_camera_opencv")),
                               matrix_of(frame.at("world_from_handle"))});
    }
  }
  if (fs::exists(dir / "response.json")) capture.response = dir / "response.json";
  return capture;
}

std::optional<glm::dmat4> true_body(const Capture& capture, const Picture& picture,
                                    const std::string& name) {
  if (name == kHandle) return picture.world_from_handle;
  return capture.world_from_body.at(name);
}

struct Errors {
  Statistics corner_px, tag_mm, tag_deg, camera_mm, camera_deg, body_mm, body_deg;
  int flips = 0;
};

double apart_mm(const glm::dmat4& a, const glm::dmat4& b) {
  return 1000.0 * glm::distance(glm::dvec3(a[3]), glm::dvec3(b[3]));
}

/// One tag by itself, as the better of its two poses.
void measure_tag(const Lens& lens, const Detection& d, double size_m,
                 const glm::dmat4& camera_from_tag, Errors& errors) {
  double sum = 0.0;
  const auto corners = tag_corners_m(size_m);
  for (std::size_t c = 0; c < 4; ++c) {
    const auto pixel = lens.project(glm::dvec3(camera_from_tag * glm::dvec4(corners[c], 1.0)));
    const glm::dvec2 miss = pixel.value() - d.corners_px[c];
    sum += glm::dot(miss, miss);
  }
  errors.corner_px.add(std::sqrt(sum / 4.0));
  const auto fits = tag_poses(lens, d.corners_px, size_m);
  if (fits.empty()) return;
  errors.tag_mm.add(apart_mm(fits[0].camera_from_body, camera_from_tag));
  const double deg = kDegrees * rotation_between_rad(fits[0].camera_from_body, camera_from_tag);
  errors.tag_deg.add(deg);
  if (deg > kFlip_deg) ++errors.flips;
}

Errors measure(const Capture& capture, const std::vector<Picture>& pictures,
               const TrackerOptions& options) {
  Errors errors;
  Tracker tracker(capture.camera, capture.layout, options);
  const Lens lens(capture.camera);
  double time_s = 0.0;
  for (const Picture& picture : pictures) {
    const TrackResult result = tracker.update(picture.image, time_s);
    time_s += 1.0 / capture.video_fps;
    const glm::dmat4 camera_from_world = rigid_inverse(picture.world_from_camera);
    const auto one = [&](const PlacedTag& tag, const glm::dmat4& world_from_tag) {
      for (const Detection& d : result.detections) {
        if (d.id == tag.id) {
          measure_tag(lens, d, tag.size_m, camera_from_world * world_from_tag, errors);
        }
      }
    };
    for (const PlacedTag& tag : capture.layout.world.tags) one(tag, tag.body_from_tag);
    for (const TaggedBody& body : capture.layout.bodies) {
      if (const auto truth = true_body(capture, picture, body.name)) one(body.tags[0], *truth);
    }
    if (result.world_from_camera) {
      errors.camera_mm.add(apart_mm(*result.world_from_camera, picture.world_from_camera));
      errors.camera_deg.add(
          kDegrees * rotation_between_rad(*result.world_from_camera, picture.world_from_camera));
    }
    for (const BodyTrack& body : result.bodies) {
      const auto truth = true_body(capture, picture, body.name);
      if (!truth || !body.world_from_body || body.held) continue;
      errors.body_mm.add(apart_mm(*body.world_from_body, *truth));
      errors.body_deg.add(kDegrees * rotation_between_rad(*body.world_from_body, *truth));
    }
  }
  return errors;
}

void print_row(const std::string& set, const std::string& mode, std::size_t pictures,
               const Errors& e) {
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", set, mode, pictures,
             e.corner_px.count(), e.corner_px.text(), e.tag_mm.text(), e.tag_deg.text(), e.flips,
             e.camera_mm.text(), e.camera_deg.text(), e.body_mm.text(), e.body_deg.text());
}

/// Frame-to-frame change of the error: what a viewer sees tremble.
struct Jitter {
  Statistics mm, deg;
  std::optional<glm::dmat4> last;

  void add(const glm::dmat4& measured, const glm::dmat4& truth) {
    const glm::dmat4 error = rigid_inverse(truth) * measured;
    if (last) {
      mm.add(apart_mm(error, *last));
      deg.add(kDegrees * rotation_between_rad(error, *last));
    }
    last = error;
  }
};

/// A still camera and still bodies whose corners tremble: the true ones plus Gaussian noise.
void measure_still(const Capture& capture, const std::string& name, const TrackerOptions& options) {
  constexpr int kFrames = 240;
  constexpr double kNoise_px = 0.1;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, kNoise_px);
  const Lens lens(capture.camera);
  const glm::dmat4 world_from_camera = capture.background[0].world_from_camera;
  const glm::dmat4 camera_from_world = rigid_inverse(world_from_camera);
  Tracker tracker(capture.camera, capture.layout, options);
  Jitter camera, body;
  Statistics camera_mm, camera_deg, body_mm, body_deg;
  for (int frame = 0; frame < kFrames; ++frame) {
    std::vector<Detection> detections;
    const auto add = [&](const PlacedTag& tag, const glm::dmat4& world_from_tag) {
      Detection d{tag.id, {}};
      const auto corners = tag_corners_m(tag.size_m);
      for (std::size_t c = 0; c < 4; ++c) {
        const auto pixel = lens.project(
            glm::dvec3(camera_from_world * world_from_tag * glm::dvec4(corners[c], 1.0)));
        if (!pixel) return;
        d.corners_px[c] = *pixel + glm::dvec2(noise(random), noise(random));
      }
      detections.push_back(d);
    };
    for (const PlacedTag& tag : capture.layout.world.tags) add(tag, tag.body_from_tag);
    for (const TaggedBody& b : capture.layout.bodies) {
      if (b.name != kHandle) add(b.tags[0], capture.world_from_body.at(b.name));
    }
    const TrackResult result = tracker.update(detections, frame / capture.video_fps);
    camera.add(result.world_from_camera.value(), world_from_camera);
    camera_mm.add(apart_mm(*result.world_from_camera, world_from_camera));
    camera_deg.add(kDegrees * rotation_between_rad(*result.world_from_camera, world_from_camera));
    for (const BodyTrack& b : result.bodies) {
      if (b.name == kHandle || b.name != capture.layout.bodies[0].name) continue;
      body.add(b.world_from_body.value(), capture.world_from_body.at(b.name));
      body_mm.add(apart_mm(*b.world_from_body, capture.world_from_body.at(b.name)));
      body_deg.add(kDegrees *
                   rotation_between_rad(*b.world_from_body, capture.world_from_body.at(b.name)));
    }
  }
  fmt::print("| {} | {:.3f} | {:.4f} | {:.3f} | {:.4f} | {:.2f} | {:.3f} | {:.2f} | {:.3f} |\n",
             name, camera.mm.rms(), camera.deg.rms(), camera_mm.rms(), camera_deg.rms(),
             body.mm.rms(), body.deg.rms(), body_mm.rms(), body_deg.rms());
}

/// Tracker with and without filter along the video: error (lag included) and jitter.
void measure_filter(const Capture& capture, const std::string& name,
                    const TrackerOptions& options) {
  Tracker tracker(capture.camera, capture.layout, options);
  Jitter camera, handle;
  Statistics camera_mm, camera_deg, handle_mm, handle_deg;
  double time_s = 0.0;
  for (const Picture& picture : capture.video) {
    const TrackResult result = tracker.update(picture.image, time_s);
    time_s += 1.0 / capture.video_fps;
    if (result.world_from_camera) {
      camera.add(*result.world_from_camera, picture.world_from_camera);
      camera_mm.add(apart_mm(*result.world_from_camera, picture.world_from_camera));
      camera_deg.add(kDegrees *
                     rotation_between_rad(*result.world_from_camera, picture.world_from_camera));
    }
    for (const BodyTrack& body : result.bodies) {
      if (body.name != kHandle || !body.world_from_body) continue;
      handle.add(*body.world_from_body, *picture.world_from_handle);
      handle_mm.add(apart_mm(*body.world_from_body, *picture.world_from_handle));
      handle_deg.add(kDegrees *
                     rotation_between_rad(*body.world_from_body, *picture.world_from_handle));
    }
  }
  fmt::print("| {} | {:.3f} | {:.4f} | {:.3f} | {:.4f} | {:.2f} | {:.3f} | {:.2f} | {:.3f} |\n",
             name, camera.mm.rms(), camera.deg.rms(), camera_mm.rms(), camera_deg.rms(),
             handle.mm.rms(), handle.deg.rms(), handle_mm.rms(), handle_deg.rms());
}

/// Filter off and on, root mean squares: trembling against lag.
void print_filter(const Capture& capture) {
  fmt::print(
      "\n| corners | filter | camera jitter mm | deg | camera error mm | deg | body jitter mm | "
      "deg | body error mm | deg |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const bool filtered : {false, true}) {
    TrackerOptions options;
    if (!filtered) options.filter.reset();
    const std::string state = filtered ? "on" : "off";
    measure_still(capture, "still, 0.1 px noise | " + state, options);
    if (!capture.video.empty()) measure_filter(capture, "video | " + state, options);
  }
}

void print_poses(const Capture& capture, const std::string& set) {
  struct Mode {
    std::string name;
    TrackerOptions options;
  };
  std::vector<Mode> modes;
  const auto add = [&](const std::string& name, bool refine, const Response& response,
                       bool filtered) {
    Mode mode{name, {}};
    mode.options.detector.refine = refine;
    mode.options.detector.response = response;
    if (!filtered) mode.options.filter.reset();
    modes.push_back(mode);
  };
  add("detector's corners", false, Response::from_gamma(1.0), false);
  add("lines, values as they are", true, Response::from_gamma(1.0), false);
  add("lines, gamma 1.8", true, Response::from_gamma(1.8), false);
  add("lines, gamma 2.2", true, Response::from_gamma(2.2), false);
  if (capture.response) {
    add("lines, response", true, read_response(*capture.response), false);
    add("lines, response, filter", true, read_response(*capture.response), true);
  }
  add("lines, gamma 2.2, filter", true, Response::from_gamma(2.2), true);
  const std::pair<const char*, const std::vector<Picture>*> sets[] = {
      {"background", &capture.background}, {"truth", &capture.truth}, {"video", &capture.video}};
  for (const auto& [name, pictures] : sets) {
    if (pictures->empty()) continue;
    for (const Mode& mode : modes) {
      print_row(set + " " + name, mode.name, pictures->size(),
                measure(capture, *pictures, mode.options));
    }
  }
}

void measure_set(const fs::path& dir) {
  const fs::path canonical = fs::canonical(dir);
  const Capture capture = read_capture(canonical);
  fmt::print(
      "\nMedian / worst.\n\n| pictures | corners | n | tags | corner px | tag mm | tag deg | flips "
      "| "
      "camera mm | camera deg | body mm | body deg |\n|---|---|---|---|---|---|---|---|---|---|---|"
      "---|\n");
  print_poses(capture, canonical.filename().string());
  print_filter(capture);
}

}  // namespace
}  // namespace gnomon::ar

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i) gnomon::ar::measure_set(argv[i]);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
