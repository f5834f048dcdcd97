#include "apps/study/tag_series.h"

#include <optional>
#include <vector>

#include "apps/study/picture_damage.h"

namespace gnomon::apps::study {

namespace {

constexpr double kStep_s = 1.0 / 12.0;

void add(Outcome& sum, const Outcome& more) {
  sum.wrong += more.wrong;
  sum.of += more.of;
  sum.not_finite += more.not_finite;
}

Outcome all_wrong(const DeskMasks& masks) {
  Outcome out = study::all_wrong(masks.shadow);
  add(out, study::all_wrong(masks.shadow_on_virtual));
  return out;
}

/// One way of tracking, along the series.
class Follower {
 public:
  Follower(Desk& desk, const TagInput& input, const DeskMasks& truth, bool filter)
      : desk_(desk),
        scene_(*input.scene),
        truth_(truth),
        tracker_(scene_.tracker(input.picture.width, input.picture.height, filter)) {}

  ar::TrackResult see(const std::vector<ar::Detection>& tags, std::size_t number) {
    const ar::TrackResult track = tracker_.update(tags, static_cast<double>(number) * kStep_s);
    const DeskPoses poses = poses_of(track);
    const std::size_t bad = not_finite(poses);
    std::optional<DeskMasks> masks;
    if (poses.world_from_camera && bad == 0)
      masks = desk_.masks(scene_.scene(poses), *poses.world_from_camera);
    if (number > 0) add(flicker, masks && last_ ? difference(*masks, *last_) : all_wrong(truth_));
    add(misplaced, masks ? difference(*masks, truth_) : all_wrong(truth_));
    misplaced.not_finite += bad;
    last_ = std::move(masks);
    return track;
  }

  Outcome flicker, misplaced;

 private:
  Desk& desk_;
  DeskScene& scene_;
  const DeskMasks& truth_;
  ar::Tracker& tracker_;
  std::optional<DeskMasks> last_;
};

void count(TagSeries& series, const ar::TrackResult& track) {
  add(series.unplaced, {track.world_from_camera ? 0.0 : 1.0, 1.0});
  add(series.unmeasured, {track.world.camera_from_body ? 0.0 : 1.0, 1.0});
  for (const ar::BodyTrack& body : track.bodies)
    add(series.bodies_unmeasured, {body.camera_from_body ? 0.0 : 1.0, 1.0});
}

}  // namespace

TagSeries run_series(Desk& desk, const TagInput& input) {
  DeskScene& scene = *input.scene;
  const DeskMasks truth = desk.masks(scene.scene(scene.poses), *scene.poses.world_from_camera);
  const ar::Lens lens(scene.camera(input.picture.width, input.picture.height));
  ar::TagDetector& detector = scene.detector();
  Follower filtered(desk, input, truth, true), measured(desk, input, truth, false);
  TagSeries out;
  for (std::size_t i = 0; i < kSeriesPictures; ++i) {
    const auto seed = static_cast<std::uint32_t>(input.seed * kSeriesPictures + i);
    const std::vector<ar::Detection> tags =
        detector.detect(noisy(input.picture, input.noise, seed), &lens);
    count(out, filtered.see(tags, i));
    measured.see(tags, i);
  }
  out.flicker = {filtered.flicker, measured.flicker};
  out.misplaced = {filtered.misplaced, measured.misplaced};
  return out;
}

}  // namespace gnomon::apps::study
