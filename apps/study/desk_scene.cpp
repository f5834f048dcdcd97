#include "apps/study/desk_scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/image_file.h"
#include "ar/pinhole_view.h"
#include "ar/video.h"
#include "pipeline/haller.h"
#include "raster/buffers.h"
#include "raster/check.h"
#include "raster/execute.h"

namespace gnomon::apps::study {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSceneFiles[] = {"01_torus_on_house.toml", "02_house_on_torus.toml",
                                       "03_tin_on_torus.toml", "04_torus_and_sphere_on_tin.toml"};
/// Pictures of the video that are taken: the card comes in front of the torus, and beside it.
constexpr std::int64_t kVideoFrames[] = {6, 18};
static_assert(std::size(kSceneFiles) == Desk::kStills);
static_assert(std::size(kVideoFrames) == Desk::kVideoPictures);

std::size_t not_finite(const std::optional<glm::dmat4>& pose) {
  if (!pose) return 0;
  std::size_t count = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) count += std::isfinite((*pose)[i][j]) ? 0 : 1;
  return count;
}

ar::Image channel(const std::vector<std::uint8_t>& rgba_rows, const ar::Image& like,
                  std::size_t number) {
  ar::Image out{like.width, like.height, 1, {}};
  out.pixels.reserve(rgba_rows.size() / 4);
  for (std::size_t i = number; i < rgba_rows.size(); i += 4) out.pixels.push_back(rgba_rows[i]);
  return out;
}

/// Sweeps compare with what the photograph as it is says.
void require_poses(const DeskScene& scene, const ar::TrackResult& track, const fs::path& picture) {
  if (!track.world_from_camera || !track.world.camera_from_body)
    throw ar::InputError(ar::one_line(picture.string()) + ": no tags of " +
                         ar::one_line(scene.file().file.string()) + " say where the camera is");
}

std::unique_ptr<DeskScene> read_still(const fs::path& folder, const char* name) {
  auto scene = std::make_unique<DeskScene>(ar::read_scene(folder / name));
  scene->photograph = ar::read_image_rgb(folder / "background.png");
  ar::Tracker& tracker = scene->tracker(scene->photograph.width, scene->photograph.height, false);
  const ar::TrackResult track = tracker.update(scene->photograph, 0.0);
  require_poses(*scene, track, folder / "background.png");
  scene->poses = poses_of(track);
  return scene;
}

/// Tracked from the first picture on, so that the card's pose is the tracker's choice.
std::unique_ptr<DeskScene> read_video(const fs::path& folder, std::int64_t frame) {
  auto scene = std::make_unique<DeskScene>(ar::read_scene(folder / "video" / "handle.toml"));
  ar::VideoReader video = ar::VideoReader::open_file(folder / "video" / "handle.avi");
  ar::Tracker& tracker = scene->tracker(video.width(), video.height(), false);
  while (const std::optional<ar::VideoFrame> next = video.next()) {
    const ar::TrackResult track = tracker.update(next->image, next->time_s);
    scene->photograph = next->image;
    if (next->index != frame) continue;
    require_poses(*scene, track, folder / "video" / "handle.avi");
    scene->poses = poses_of(track);
    return scene;
  }
  throw ar::InputError((folder / "video" / "handle.avi").string() + ": too short");
}

}  // namespace

DeskPoses poses_of(const ar::TrackResult& track) {
  DeskPoses poses{.world_from_camera = track.world_from_camera, .bodies = {}};
  for (const ar::BodyTrack& body : track.bodies)
    poses.bodies.push_back({body.name, body.world_from_body});
  return poses;
}

std::size_t not_finite(const DeskPoses& poses) {
  std::size_t count = not_finite(poses.world_from_camera);
  for (const DeskPoses::Body& body : poses.bodies) count += not_finite(body.world_from_body);
  return count;
}

Outcome difference(const ar::Image& a, const ar::Image& b) {
  raster::require(a.pixels.size() == b.pixels.size(), "masks of one size are compared");
  Outcome out;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    out.wrong += a.pixels[i] != b.pixels[i];
    out.of += (a.pixels[i] | b.pixels[i]) != 0;
  }
  return out;
}

Outcome difference(const DeskMasks& a, const DeskMasks& b) {
  const Outcome real = difference(a.shadow, b.shadow);
  const Outcome other = difference(a.shadow_on_virtual, b.shadow_on_virtual);
  return {real.wrong + other.wrong, real.of + other.of};
}

Outcome all_wrong(const ar::Image& mask) {
  const auto set = static_cast<double>(
      std::ranges::count_if(mask.pixels, [](std::uint8_t v) { return v != 0; }));
  return {set, set};
}

DeskScene::DeskScene(ar::SceneFile file)
    : file_(std::move(file)),
      camera_(ar::read_camera(file_.camera_file)),
      response_(file_.response_file ? ar::read_response(*file_.response_file)
                                    : ar::Response::from_gamma(file_.gamma.value_or(2.2))),
      nodes_(file_, ar::load_models(file_)) {}

ar::CameraModel DeskScene::camera(int width, int height) const {
  return ar::camera_for_picture(camera_, width, height);
}

ar::TrackerOptions DeskScene::options() const {
  ar::TrackerOptions out;
  out.detector.response = response_;
  const ar::FilterSettings& filter = file_.filter;
  out.filter = ar::OneEuroOptions{filter.min_cutoff_hz, filter.beta_per_m, filter.beta_per_rad,
                                  filter.speed_cutoff_hz};
  return out;
}

ar::Tracker& DeskScene::tracker(int width, int height, bool filter) {
  auto found = trackers_.find({width, height, filter});
  if (found == trackers_.end()) {
    ar::TrackerOptions chosen = options();
    if (!filter) chosen.filter.reset();
    found = trackers_
                .emplace(std::tuple{width, height, filter},
                         ar::Tracker(camera(width, height), file_.tags, chosen))
                .first;
  }
  found->second.reset();
  return found->second;
}

ar::TagDetector& DeskScene::detector() {
  if (!detector_) detector_.emplace(file_.families, file_.dictionaries, options().detector);
  return *detector_;
}

pipeline::Scene DeskScene::scene(const DeskPoses& placed) {
  for (const DeskPoses::Body& body : placed.bodies) nodes_.place(body.name, body.world_from_body);
  return nodes_.scene();
}

struct Desk::View {
  double near_m, far_m;
  ar::PinholeView pinhole;
  /// The photograph, which no mask depends on.
  ar::Image under;
  raster::ColorBuffer color, masks;
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;
  raster::ExecuteMemory memory;
  pipeline::TopologyCache topologies;
  pipeline::VolumeMemory volumes;

  explicit View(const DeskScene& scene)
      : near_m(scene.file().near_m),
        far_m(scene.file().far_m),
        pinhole(ar::Lens(scene.camera(scene.photograph.width, scene.photograph.height)), 1),
        under(pinhole.resample(scene.photograph)),
        color(under.width, under.height),
        masks(under.width, under.height),
        depth(under.width, under.height),
        stencil(under.width, under.height) {}
};

Desk::Desk(fs::path folder, int threads) : folder_(std::move(folder)), threads_(threads) {}
Desk::~Desk() = default;

DeskScene& Desk::scene(std::size_t number) {
  raster::require(number < kStills + kVideoPictures, "the desk has this scene");
  scenes_.resize(kStills + kVideoPictures);
  if (!scenes_[number])
    scenes_[number] = number < kStills ? read_still(folder_, kSceneFiles[number])
                                       : read_video(folder_, kVideoFrames[number - kStills]);
  return *scenes_[number];
}

DeskMasks Desk::masks(const pipeline::Scene& scene, const glm::dmat4& world_from_camera) {
  if (!view_) view_ = std::make_unique<View>(this->scene(0));
  View& at = *view_;
  const auto under = raster::ImageView::from_top_row(at.under.pixels.data(), at.under.width,
                                                     at.under.height, at.under.channels);
  pipeline::HallerOptions options;
  options.masks = &at.masks;
  options.topologies = &at.topologies;
  options.volumes = &at.volumes;
  options.threads = threads_;
  const pipeline::Camera camera = at.pinhole.camera(world_from_camera, at.near_m, at.far_m);
  raster::execute(
      pipeline::record_haller(scene, camera, under, {&at.color, &at.depth, &at.stencil}, options),
      {.threads = threads_, .memory = &at.memory});
  const std::vector<std::uint8_t> rows = at.masks.to_rgba8_rows();
  return {channel(rows, at.under, 0), channel(rows, at.under, 1), channel(rows, at.under, 2)};
}

}  // namespace gnomon::apps::study
