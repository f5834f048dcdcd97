#include "ar/session.h"

#include <algorithm>
#include <chrono>

#include "ar/camera.h"
#include "ar/error.h"
#include "ar/lit_scene_file.h"
#include "ar/response.h"
#include "ar/scene_nodes.h"
#include "ar/session_options.h"
#include "ar/tag_layout_file.h"

namespace gnomon::ar {

namespace {

TrackerOptions tracker_options(const SceneFile& file, const SessionOptions& options) {
  TrackerOptions out;
  out.dictionaries = file.dictionaries;
  if (file.response_file) out.detector.response = read_response(*file.response_file);
  if (file.gamma) out.detector.response = Response::from_gamma(*file.gamma);
  out.filter.reset();
  if (file.filter.on && !options.no_filter)
    out.filter = OneEuroOptions{file.filter.min_cutoff_hz, file.filter.beta_per_m,
                                file.filter.beta_per_rad, file.filter.speed_cutoff_hz};
  return out;
}

}  // namespace

struct Session::Impl {
  SceneFile file;
  TagLayout layout;
  Lens lens;
  Augmenter augmenter;
  /// Made with the first picture that has a pose, since receivers may depend on it.
  std::optional<DifferentialFile> differential_settings;
  std::shared_ptr<const pipeline::LitScene> lit;
  std::optional<DifferentialAugmenter> differential;
  bool still;
  std::optional<Tracker> tracker;
  std::vector<std::string> notes;
  std::optional<SceneNodes> nodes;

  Impl(const SceneFile& scene_file, int width, int height, const SessionOptions& options)
      : file(scene_file),
        layout(scene_file.tags),
        lens(photograph_camera(scene_file, width, height)),
        augmenter(lens, augment_options(scene_file, options)),
        differential_settings(differential_file(scene_file, options)),
        still(options.still) {
    if (differential_settings)
      lit = std::make_shared<const pipeline::LitScene>(
          read_lit_scene(differential_settings->lit_scene));
    const auto is_virtual = [](const SceneObject& o) {
      return o.role == pipeline::Role::virtual_object;
    };
    if (std::ranges::none_of(file.objects, is_virtual))
      throw InputError(file.file.string() +
                       ": [[object]]: none has role = \"virtual\", so there is nothing to draw");
    nodes.emplace(file, load_models(file, &notes));
    if (file.tags_yaml) add_bundles(*file.tags_yaml);
    check_bodies();
    if (!layout.world.tags.empty() || !layout.bodies.empty())
      tracker.emplace(lens.camera(), layout, tracker_options(file, options));
  }

  void add_bundles(const TagsYaml& yaml) {
    const TagLayout read = read_tags_yaml(yaml.file, yaml.family, yaml.world);
    layout.world.tags.insert(layout.world.tags.end(), read.world.tags.begin(),
                             read.world.tags.end());
    layout.bodies.insert(layout.bodies.end(), read.bodies.begin(), read.bodies.end());
  }

  std::string yaml_name() const {
    return file.tags_yaml ? file.tags_yaml->file.string() : "a tags_yaml";
  }

  /// Bodies of a ROS file are only known here; the scene file's own were checked by its reader.
  void check_bodies() const {
    for (const std::string& name : nodes->bodies()) {
      const auto named = [&](const TaggedBody& body) { return body.name == name; };
      if (std::ranges::none_of(layout.bodies, named))
        throw InputError(file.file.string() + ": attached_to or node: there is no body '" + name +
                         "', neither a [[body]] nor in " + yaml_name());
    }
  }

  /// The pose of the body with this name in the world.
  std::optional<glm::dmat4> world_from_body(const SessionResult& result,
                                            const std::string& name) const {
    const auto body = std::find_if(result.track.bodies.begin(), result.track.bodies.end(),
                                   [&](const BodyTrack& b) { return b.name == name; });
    if (body == result.track.bodies.end()) return std::nullopt;
    if (!file.world_from_camera) return body->world_from_body;
    if (!body->camera_from_body) return std::nullopt;
    return *file.world_from_camera * *body->camera_from_body;
  }

  void augment(const Image& picture, SessionResult& result) {
    const glm::dmat4& pose = *result.world_from_camera;
    if (!lit) {
      result.augmented = augmenter.augment(picture, result.scene, pose);
      return;
    }
    const bool stays = still || file.world_from_camera;
    if (!differential)
      differential.emplace(lens, lit, stays ? std::optional(pose) : std::nullopt,
                           differential_settings->settings);
    result.augmented = differential->augment(picture, result.scene, pose);
    result.differential = differential->report();
  }

  void place(SessionResult& result) {
    for (const std::string& body : nodes->bodies())
      nodes->place(body, world_from_body(result, body));
    result.scene = nodes->scene();
    result.left_out = nodes->left_out();
  }
};

Session::Session(const SceneFile& file, int width, int height, const SessionOptions& options)
    : impl_(std::make_unique<Impl>(file, width, height, options)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;

void Session::keep_steps(bool keep) {
  impl_->augmenter.keep_steps(keep);
  if (impl_->differential_settings) impl_->differential_settings->settings.steps = keep;
  if (impl_->differential) impl_->differential->keep_steps(keep);
}

SessionResult Session::process(const Image& picture, double time_s, bool draw) {
  SessionResult result;
  const auto start = std::chrono::steady_clock::now();
  if (impl_->tracker) result.track = impl_->tracker->update(picture, time_s);
  result.track_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  result.world_from_camera = impl_->file.world_from_camera ? impl_->file.world_from_camera
                                                           : result.track.world_from_camera;
  if (!result.world_from_camera) return result;
  impl_->place(result);
  const bool placed = std::any_of(
      result.scene.objects.begin(), result.scene.objects.end(),
      [](const pipeline::Object& o) { return o.role == pipeline::Role::virtual_object; });
  if (placed && draw) impl_->augment(picture, result);
  return result;
}

const std::vector<std::string>& Session::notes() const { return impl_->notes; }

std::string Session::known_tags() const {
  std::string names;
  const auto add = [&](const TaggedBody& body) {
    for (const PlacedTag& tag : body.tags)
      names += (names.empty() ? "" : ", ") + tag.id.family + " " + std::to_string(tag.id.number);
  };
  add(impl_->layout.world);
  for (const TaggedBody& body : impl_->layout.bodies) add(body);
  return names;
}

const PinholeView& Session::view() const {
  return impl_->differential ? impl_->differential->view() : impl_->augmenter.view();
}

}  // namespace gnomon::ar
