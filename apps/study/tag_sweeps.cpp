#include "apps/study/tag_sweeps.h"

#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "apps/study/picture_damage.h"
#include "apps/study/planned_sweep.h"
#include "apps/study/tag_picture.h"
#include "apps/study/tag_series.h"
#include "ar/pose.h"

namespace gnomon::apps::study {

namespace {

/// Values of a camera's noise in good light.
constexpr double kCameraNoise = 2.0;

/// A kind of damage.
struct Damage {
  std::string name, title, explanation, parameter;
  std::vector<std::string> values;
  std::size_t inputs = 0;
  /// There are bodies with tags of their own.
  bool bodies = true;
  std::function<TagInput(std::size_t value, std::size_t input)> make;
};

/// Runs each series once for all that is measured of it.
class Trial {
 public:
  Trial(std::shared_ptr<Desk> desk, Damage damage)
      : desk_(std::move(desk)), damage_(std::move(damage)) {}

  const Damage& damage() const { return damage_; }
  const TagSeries& run(std::size_t value, std::size_t input) {
    const std::pair key{value, input};
    auto found = known_.find(key);
    if (found == known_.end()) {
      TagInput made = damage_.make(value, input);
      made.seed = static_cast<std::uint32_t>(value * damage_.inputs + input);
      found = known_.emplace(key, run_series(*desk_, made)).first;
    }
    return found->second;
  }

 private:
  std::shared_ptr<Desk> desk_;
  Damage damage_;
  std::map<std::pair<std::size_t, std::size_t>, TagSeries> known_;
};

PlannedSweep::Plan plan(const std::shared_ptr<Trial>& trial, const std::string& suffix,
                        const std::string& title, SweepText text) {
  const Damage& damage = trial->damage();
  text.name = damage.name + "-" + suffix;
  text.title = damage.title + title;
  text.explanation =
      damage.explanation +
      fmt::format(" Series of {} pictures, a twelfth of a second apart.", kSeriesPictures);
  text.parameter = damage.parameter;
  PlannedSweep::Plan out;
  out.text = std::move(text);
  out.values = damage.values;
  out.inputs = damage.inputs;
  return out;
}

void add(Sweeps& sweeps, const std::shared_ptr<Desk>& desk, Damage damage) {
  const bool bodies = damage.bodies;
  const auto trial = std::make_shared<Trial>(desk, std::move(damage));
  PlannedSweep::Plan lost =
      plan(trial, "lost", ": poses that are lost",
           {.measure = "pictures (of bodies: pictures and bodies) without a pose, of all",
            .oracle = "all of them having one"});
  lost.methods = {"camera, a pose is held for 0.25 s", "camera, each picture by itself"};
  if (bodies) lost.methods.emplace_back("bodies with one tag, each picture by itself");
  lost.run = [trial, bodies](std::size_t value, std::size_t input) {
    const TagSeries& series = trial->run(value, input);
    std::vector<Outcome> out{series.unplaced, series.unmeasured};
    if (bodies) out.push_back(series.bodies_unmeasured);
    return out;
  };
  PlannedSweep::Plan flicker =
      plan(trial, "flicker", ": shadows that flicker",
           {.measure = "pixels of the shadow that change from picture to picture, of it (all of it "
                       "where there is no pose)",
            .oracle = "the camera standing still"});
  flicker.run = [trial](std::size_t value, std::size_t input) {
    const TagSeries& series = trial->run(value, input);
    return std::vector<Outcome>(series.flicker.begin(), series.flicker.end());
  };
  PlannedSweep::Plan misplaced =
      plan(trial, "misplaced", ": shadows in the wrong place",
           {.measure = "pixels of the shadow that differ, of it or the true one (all of it where "
                       "there is no pose)",
            .oracle = "the shadow at the true poses"});
  misplaced.run = [trial](std::size_t value, std::size_t input) {
    const TagSeries& series = trial->run(value, input);
    return std::vector<Outcome>(series.misplaced.begin(), series.misplaced.end());
  };
  flicker.methods = misplaced.methods = {"filter on", "filter off"};
  for (PlannedSweep::Plan* made : {&lost, &flicker, &misplaced})
    sweeps.push_back(std::make_unique<PlannedSweep>(std::move(*made)));
}

template <class T>
std::vector<std::string> shown(const T& values) {
  std::vector<std::string> out;
  for (const auto& value : values) out.push_back(fmt::format("{}", value));
  return out;
}

const std::string kOnDesk = "The desk's four photographs with a camera's noise (2 values), ";

/// The desk's photographs, damaged.
Damage on_desk(const std::shared_ptr<Desk>& desk, Damage damage,
               std::function<ar::Image(DeskScene&, std::size_t value, std::size_t input)> how) {
  damage.inputs = Desk::kStills;
  damage.make = [desk, how = std::move(how)](std::size_t value, std::size_t input) {
    DeskScene& scene = desk->scene(input % Desk::kStills);
    return TagInput{.scene = &scene, .picture = how(scene, value, input), .noise = kCameraNoise};
  };
  return damage;
}

constexpr double kBlur_px[] = {0, 0.5, 1, 1.5, 2, 3, 4, 6};
constexpr double kLight[] = {1, 0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02};
constexpr int kWidth[] = {640, 512, 400, 320, 256, 200, 160, 128, 80};
/// Of a tag's black square.
constexpr int kCovered_percent[] = {0, 1, 3, 5, 10, 20, 40, 60};
constexpr double kNoise[] = {0, 1, 2, 5, 10, 20, 40, 60, 80};
/// Percent that the exponent is off.
constexpr double kGamma_percent[] = {0, 5, 10, 20, 50, 100, 200, 400};
constexpr double kAngle_deg[] = {0, 20, 40, 60, 70, 75, 80, 85};

Damage blur(const std::shared_ptr<Desk>& desk) {
  return on_desk(desk,
                 {.name = "tags-blurred",
                  .title = "Tags out of focus",
                  .explanation = kOnDesk + "their light spread by a Gaussian. Tags are 31 to 51 "
                                           "pixels wide, a module 4 to 6.",
                  .parameter = "standard deviation, pixels",
                  .values = shown(kBlur_px)},
                 [](DeskScene& scene, std::size_t value, std::size_t) {
                   return blurred(scene.photograph, kBlur_px[value], scene.response());
                 });
}

Damage dark(const std::shared_ptr<Desk>& desk) {
  return on_desk(desk,
                 {.name = "tags-dark",
                  .title = "Tags in too little light",
                  .explanation = kOnDesk + "with a part of their light in eight bits.",
                  .parameter = "part of the light",
                  .values = shown(kLight)},
                 [](DeskScene& scene, std::size_t value, std::size_t) {
                   return darkened(scene.photograph, kLight[value], scene.response());
                 });
}

Damage small(const std::shared_ptr<Desk>& desk) {
  return on_desk(
      desk,
      {.name = "tags-small",
       .title = "Tags too small",
       .explanation = kOnDesk + "made smaller; shadows are drawn in the photograph's own "
                                "size. At 640 pixels tags are 31 to 51 pixels wide.",
       .parameter = "the picture's width, pixels",
       .values = shown(kWidth)},
      [](DeskScene& scene, std::size_t value, std::size_t) {
        return shrunk_to(scene.photograph, kWidth[value], scene.response());
      });
}

Damage cover(const std::shared_ptr<Desk>& desk) {
  return on_desk(
      desk,
      {.name = "tags-covered",
       .title = "Tags partly covered",
       .explanation = kOnDesk + "every tag covered from one side on: its border and a "
                                "share of its black square. One that is still read is taken for a "
                                "narrower or wider one.",
       .parameter = "percent of a tag",
       .values = shown(kCovered_percent)},
      [](DeskScene& scene, std::size_t value, std::size_t input) {
        const ar::Image& photo = scene.photograph;
        const ar::Lens lens(scene.camera(photo.width, photo.height));
        std::vector<ar::TagCorners> tags;
        for (const ar::Detection& tag : scene.detector().detect(photo, &lens))
          tags.push_back(tag.corners_px);
        return covered(photo, tags, kCovered_percent[value] / 100.0, input % 4);
      });
}

Damage noise(const std::shared_ptr<Desk>& desk) {
  Damage damage =
      on_desk(desk,
              {.name = "tags-noisy",
               .title = "Tags in noise",
               .explanation = "The desk's four photographs with Gaussian noise of each "
                              "value.",
               .parameter = "standard deviation, values of 255",
               .values = shown(kNoise)},
              [](DeskScene& scene, std::size_t, std::size_t) { return scene.photograph; });
  damage.make = [make = damage.make](std::size_t value, std::size_t input) {
    TagInput made = make(value, input);
    made.noise = kNoise[value];
    return made;
  };
  return damage;
}

Damage gamma(const std::shared_ptr<Desk>& desk) {
  Damage damage = on_desk(desk,
                          {.name = "tags-gamma",
                           .title = "Tags measured with a wrong response curve",
                           .explanation = kOnDesk + "values bent by an exponent up and down, and "
                                                    "measured with the camera's own curve.",
                           .parameter = "percent that the exponent is off",
                           .values = shown(kGamma_percent)},
                          [](DeskScene& scene, std::size_t value, std::size_t input) {
                            const double off = 1.0 + kGamma_percent[value] / 100.0;
                            return bent(scene.photograph, input < Desk::kStills ? off : 1.0 / off);
                          });
  damage.inputs = 2 * Desk::kStills;
  return damage;
}

/// One tag on the desk's table, a torus beside it, a camera 80 cm away: a scene an angle and side,
/// with the true pose.
class ObliqueScenes {
 public:
  static constexpr std::size_t kSides = 4;

  explicit ObliqueScenes(std::shared_ptr<Desk> desk) : desk_(std::move(desk)) {}

  DeskScene& of(std::size_t value, std::size_t side) {
    std::unique_ptr<DeskScene>& scene = known_[{value, side}];
    if (scene) return *scene;
    const DeskScene& desk = desk_->scene(0);
    scene = std::make_unique<DeskScene>(scene_file(desk.file()));
    const ar::PlacedTag& tag = scene->file().tags.world.tags.front();
    const ar::Lens lens(scene->camera(desk.photograph.width, desk.photograph.height));
    const glm::dmat4 world_from_camera = world_from_camera_at(
        glm::dvec3(tag.body_from_tag[3]), 0.8, glm::radians(kAngle_deg[value]),
        // Off the axes, so that no edge lies along the pixels; the near half of the desk.
        glm::radians(200.0 + 47.0 * static_cast<double>(side)));
    scene->photograph =
        picture_of_tag(lens, ar::rigid_inverse(world_from_camera) * tag.body_from_tag, tag.size_m,
                       scene->response());
    scene->poses = {.world_from_camera = world_from_camera, .bodies = {}};
    return *scene;
  }

 private:
  static ar::SceneFile scene_file(ar::SceneFile file) {
    file.tags.bodies.clear();
    file.tags.world.tags.resize(1);
    // On the table's middle, where neither bodies nor the books are.
    file.tags.world.tags[0].id.number = 0;
    file.tags.world.tags[0].body_from_tag[3] = {0.13, 0.7415, -1.0, 1.0};
    std::erase_if(file.objects, [](const ar::SceneObject& object) {
      return object.name != "desk" && object.name != "torus";
    });
    for (ar::SceneObject& object : file.objects)
      if (object.name == "torus") {
        object.body_from_object = glm::dmat4(1.0);
        object.body_from_object[3] = {0.22, 0.85, -1.05, 1.0};
      }
    return file;
  }

  std::shared_ptr<Desk> desk_;
  std::map<std::pair<std::size_t, std::size_t>, std::unique_ptr<DeskScene>> known_;
};

Damage oblique(const std::shared_ptr<Desk>& desk) {
  const auto scenes = std::make_shared<ObliqueScenes>(desk);
  return {.name = "tag-oblique",
          .title = "One tag seen obliquely",
          .explanation =
              "Pictures by formula of one tag of 8 cm on a table, from 80 cm away and "
              "four sides, with a camera's noise (2 values); a virtual torus floats "
              "beside it.",
          .parameter = "degrees from the tag's normal",
          .values = shown(kAngle_deg),
          .inputs = ObliqueScenes::kSides,
          .bodies = false,
          .make = [scenes](std::size_t value, std::size_t input) {
            DeskScene& scene = scenes->of(value, input);
            return TagInput{.scene = &scene, .picture = scene.photograph, .noise = kCameraNoise};
          }};
}

}  // namespace

void add_tag_sweeps(Sweeps& sweeps, const std::shared_ptr<Desk>& desk) {
  for (const auto& kind : {blur, dark, small, cover, noise, gamma, oblique})
    add(sweeps, desk, kind(desk));
}

}  // namespace gnomon::apps::study
