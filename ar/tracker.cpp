#include "ar/tracker.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "ar/tag_layout_file.h"

namespace gnomon::ar {
namespace {

std::vector<std::string> families_of(const TagLayout& layout) {
  std::set<std::string> names;
  for (const PlacedTag& tag : layout.world.tags) names.insert(tag.id.family);
  for (const TaggedBody& body : layout.bodies) {
    for (const PlacedTag& tag : body.tags) names.insert(tag.id.family);
  }
  return {names.begin(), names.end()};
}

std::array<glm::dvec3, 4> corners_on_body(const PlacedTag& tag) {
  std::array<glm::dvec3, 4> corners = tag_corners_m(tag.size_m);
  for (glm::dvec3& p : corners) p = glm::dvec3(tag.body_from_tag * glm::dvec4(p, 1.0));
  return corners;
}

double perimeter(const TagCorners& c) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) sum += glm::distance(c[i], c[(i + 1) % 4]);
  return sum;
}

/// Smooths what mirrored poses are compared with, whether or not the output is filtered: a single
/// noisy picture must not carry the memory over to the other side.
constexpr OneEuroOptions kSettling{.min_cutoff_hz = 2.0, .beta_per_m = 0.0, .beta_per_rad = 0.0};

/// What is remembered of a body (as world_from_body), or of the world (as world_from_camera).
struct Memory {
  PoseChooser chooser;
  std::optional<PoseFilter> filter;
  PoseFilter settling{kSettling};
  std::optional<glm::dmat4> settled;
  /// What was given out last.
  std::optional<glm::dmat4> given;
  double seen_s = 0.0;
};

/// The detection of this tag: of several, the one nearest to where `prior` puts it, else the
/// largest.
const Detection* find(const std::vector<Detection>& detections, const PlacedTag& tag,
                      const Lens& lens, const std::optional<glm::dmat4>& prior) {
  const Detection* best = nullptr;
  double best_score = 0.0;
  for (const Detection& d : detections) {
    if (d.id != tag.id) continue;
    double score = perimeter(d.corners_px);
    if (prior) {
      const glm::dvec4 centre = *prior * tag.body_from_tag[3];
      const auto pixel = lens.project(glm::dvec3(centre));
      const glm::dvec2 seen = 0.5 * (d.corners_px[0] + d.corners_px[2]);
      if (pixel) score = -glm::distance(*pixel, seen);
    }
    if (best == nullptr || score > best_score) {
      best = &d;
      best_score = score;
    }
  }
  return best;
}

}  // namespace

struct Tracker::Impl {
  CameraModel camera;
  TagLayout layout;
  TrackerOptions options;
  TagDetector detector;
  std::optional<Lens> lens;
  Memory world;
  std::vector<Memory> bodies;

  Impl(const CameraModel& c, const TagLayout& l, const TrackerOptions& o)
      : camera(c), layout(l), options(o), detector(families_of(l), o.dictionaries, o.detector) {
    if (camera.width > 0) lens.emplace(camera);
    bodies.resize(layout.bodies.size());
    reset();
  }

  void reset() {
    world = Memory{};
    if (options.filter) {
      OneEuroOptions camera_filter = *options.filter;
      camera_filter.beta_per_m *= options.camera_beta_gain_per_m;
      camera_filter.beta_per_rad *= options.camera_beta_gain_per_rad;
      world.filter.emplace(camera_filter);
    }
    for (Memory& body : bodies) {
      body = Memory{};
      if (options.filter) body.filter.emplace(*options.filter);
    }
  }

  const Lens& lens_for(const Image& picture);
  BodyTrack measure(const TaggedBody& body, const std::vector<Detection>& detections,
                    Memory& memory, const std::optional<glm::dmat4>& prior) const;
  std::optional<glm::dmat4> give(Memory& memory, const std::optional<glm::dmat4>& pose,
                                 double time_s, bool& held) const;
  TrackResult track(std::vector<Detection> detections, double time_s);
};

const Lens& Tracker::Impl::lens_for(const Image& picture) {
  if (!lens || lens->camera().width != picture.width || lens->camera().height != picture.height) {
    lens.emplace(camera_for_picture(camera, picture.width, picture.height));
  }
  return *lens;
}

BodyTrack Tracker::Impl::measure(const TaggedBody& body, const std::vector<Detection>& detections,
                                 Memory& memory, const std::optional<glm::dmat4>& prior) const {
  BodyTrack track;
  track.name = body.name;
  std::vector<TagView> views;
  std::vector<TagId> seen;
  for (const PlacedTag& tag : body.tags) {
    const Detection* d = find(detections, tag, *lens, prior);
    if (d == nullptr) {
      track.missing.push_back(tag.id);
    } else {
      views.push_back({corners_on_body(tag), d->corners_px});
      seen.push_back(tag.id);
    }
  }
  const std::vector<PoseFit> fits = body_poses(*lens, views, options.pose, prior);
  if (fits.empty()) {
    track.rejected = seen;
    return track;
  }
  const PoseFit& fit = fits[memory.chooser.choose(fits, prior)];
  track.camera_from_body = fit.camera_from_body;
  track.rms_px = fit.rms_px;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    (fit.used[i] ? track.used : track.rejected).push_back(seen[i]);
  }
  return track;
}

/// The pose to give out: filtered, or the last one for a short while.
std::optional<glm::dmat4> Tracker::Impl::give(Memory& memory, const std::optional<glm::dmat4>& pose,
                                              double time_s, bool& held) const {
  const double gap_s = time_s - memory.seen_s;
  const bool recent = memory.given && gap_s >= 0.0 && gap_s <= options.hold_s;
  if (pose) {
    if (!recent) {
      if (memory.filter) memory.filter->reset();
      memory.settling.reset();
    }
    memory.settled = memory.settling.filter(*pose, time_s);
    memory.given = memory.filter ? memory.filter->filter(*pose, time_s) : *pose;
    memory.seen_s = time_s;
  } else if (recent) {
    held = true;
  } else {
    memory.given.reset();
    memory.settled.reset();
    memory.chooser.reset();
  }
  return memory.given;
}

TrackResult Tracker::Impl::track(std::vector<Detection> detections, double time_s) {
  TrackResult result;
  result.detections = std::move(detections);
  const auto within_hold = [&](const Memory& m) {
    return m.given && time_s >= m.seen_s && time_s - m.seen_s <= options.hold_s;
  };
  std::optional<glm::dmat4> world_from_camera_measured;
  if (layout.world.tags.empty()) {
    world_from_camera_measured = opengl_from_opencv_axes();
    result.world_from_camera = world_from_camera_measured;
  } else {
    std::optional<glm::dmat4> prior;
    if (within_hold(world)) prior = rigid_inverse(*world.settled);
    result.world = measure(layout.world, result.detections, world, prior);
    if (result.world.camera_from_body) {
      world_from_camera_measured = rigid_inverse(*result.world.camera_from_body);
    }
    result.world_from_camera = give(world, world_from_camera_measured, time_s, result.world.held);
    if (!world_from_camera_measured) world_from_camera_measured = result.world_from_camera;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Memory& memory = bodies[i];
    // A body that rests while the camera moves is where it was in the world.
    std::optional<glm::dmat4> prior;
    if (within_hold(memory) && world_from_camera_measured) {
      prior = rigid_inverse(*world_from_camera_measured) * *memory.settled;
    }
    BodyTrack track = measure(layout.bodies[i], result.detections, memory, prior);
    std::optional<glm::dmat4> world_from_body;
    if (track.camera_from_body && world_from_camera_measured) {
      world_from_body = *world_from_camera_measured * *track.camera_from_body;
    }
    track.world_from_body = give(memory, world_from_body, time_s, track.held);
    result.bodies.push_back(std::move(track));
  }
  return result;
}

std::optional<glm::dmat4> TrackResult::world_from_camera_opengl() const {
  if (!world_from_camera) return std::nullopt;
  return *world_from_camera * opengl_from_opencv_axes();
}

Tracker::Tracker(const CameraModel& camera, const TagLayout& layout,
                 const TrackerOptions& options) {
  check_layout(layout, "tag layout");
  impl_ = std::make_unique<Impl>(camera, layout, options);
}

Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

TrackResult Tracker::update(const Image& picture, double time_s) {
  const Lens& lens = impl_->lens_for(picture);
  return impl_->track(impl_->detector.detect(picture, &lens), time_s);
}

TrackResult Tracker::update(const std::vector<Detection>& detections, double time_s) {
  if (!impl_->lens) impl_->lens.emplace(impl_->camera);
  return impl_->track(detections, time_s);
}

void Tracker::reset() { impl_->reset(); }

}  // namespace gnomon::ar
