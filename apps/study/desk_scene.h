// The example desk: photographs with tags and phantoms, and Haller's method on them. Everything is
// read when it is first asked for.
// Invariant: the same masks for every number of threads.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>

#include "apps/study/sweep.h"
#include "ar/camera.h"
#include "ar/image.h"
#include "ar/response.h"
#include "ar/scene_file.h"
#include "ar/scene_models.h"
#include "ar/scene_nodes.h"
#include "ar/tracker.h"
#include "pipeline/scene.h"

namespace gnomon::apps::study {

/// Where tags put the camera (OpenCV's axes) and bodies; absent: not known.
struct DeskPoses {
  std::optional<glm::dmat4> world_from_camera;
  struct Body {
    std::string name;
    std::optional<glm::dmat4> world_from_body;
  };
  std::vector<Body> bodies;
};

DeskPoses poses_of(const ar::TrackResult& track);
/// Numbers of the poses that are not finite.
std::size_t not_finite(const DeskPoses& poses);

/// What is compared (ar::Augmented's masks), in the photograph's pinhole view with one sample a
/// pixel: one channel, 255 or 0, rows from the bottom.
struct DeskMasks {
  ar::Image shadow, shadow_on_virtual, object;
};

/// Pixels that are set in one of the masks, of those set in either. Precondition: of one size.
Outcome difference(const ar::Image& a, const ar::Image& b);
/// The same of several masks.
Outcome difference(const DeskMasks& a, const DeskMasks& b);
/// All of a mask is missing.
Outcome all_wrong(const ar::Image& mask);

/// One scene file, and where things are on its photograph as it is.
class DeskScene {
 public:
  /// Throws ar::InputError.
  explicit DeskScene(ar::SceneFile file);

  const ar::SceneFile& file() const { return file_; }
  const ar::Response& response() const { return response_; }
  /// For pictures of this size.
  ar::CameraModel camera(int width, int height) const;
  /// As Session makes it, with nothing seen so far; good until the next one of the same kind.
  ar::Tracker& tracker(int width, int height, bool filter);
  ar::TagDetector& detector();
  /// Objects whose body has no pose are left out.
  pipeline::Scene scene(const DeskPoses& placed);

  /// Of the photograph as it is.
  ar::Image photograph;
  DeskPoses poses;

 private:
  ar::TrackerOptions options() const;

  ar::SceneFile file_;
  ar::CameraModel camera_;
  ar::Response response_;
  ar::SceneNodes nodes_;
  /// By width, height and filter.
  std::map<std::tuple<int, int, bool>, ar::Tracker> trackers_;
  std::optional<ar::TagDetector> detector_;
};

class Desk {
 public:
  /// The four photographs, and as many pictures of the video with the hand-held card.
  static constexpr std::size_t kStills = 4, kVideoPictures = 2;

  /// `folder` is examples/desk.
  Desk(std::filesystem::path folder, int threads);
  ~Desk();

  /// Below kStills a photograph, then the video's. Throws ar::InputError.
  DeskScene& scene(std::size_t number);

  /// Haller's method; the camera is that of the photographs.
  DeskMasks masks(const pipeline::Scene& scene, const glm::dmat4& world_from_camera);

 private:
  struct View;

  std::filesystem::path folder_;
  int threads_;
  std::vector<std::unique_ptr<DeskScene>> scenes_;
  std::unique_ptr<View> view_;
};

}  // namespace gnomon::apps::study
