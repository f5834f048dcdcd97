#include "apps/study/phantom_sweeps.h"

#include <array>
#include <functional>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "apps/study/bounding_box.h"
#include "apps/study/planned_sweep.h"
#include "pipeline/bounds.h"
#include "pipeline/mesh_simplify.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

namespace {

using ModelPointer = std::shared_ptr<const pipeline::Model>;

constexpr const char* kOfEither = "pixels of a mask that differ, of those set in either";
constexpr const char* kExact = "the same method with the scene as it is";
constexpr std::size_t kInputs = Desk::kStills + Desk::kVideoPictures;

constexpr std::size_t kAxes = 3;

/// Along an axis, forth in one input and back in the next.
glm::vec3 direction(std::size_t input) {
  glm::vec3 out(0.0f);
  out[static_cast<int>(input % kAxes)] = input % 2 == 0 ? 1.0f : -1.0f;
  return out;
}

/// Changes the scene of a value; `input` is the input's number.
using Change = std::function<void(std::size_t value, std::size_t input, pipeline::Scene& scene)>;

/// The three masks of a changed scene beside those of the scene as it is, which are kept.
class MaskTrial {
 public:
  MaskTrial(std::shared_ptr<Desk> desk, Change change)
      : desk_(std::move(desk)), change_(std::move(change)) {}

  std::vector<Outcome> run(std::size_t value, std::size_t input, std::size_t ways) {
    const std::size_t number = input / ways;
    DeskScene& at = desk_->scene(number);
    pipeline::Scene scene = at.scene(at.poses);
    if (!exact_.contains(number))
      exact_.emplace(number, desk_->masks(scene, *at.poses.world_from_camera));
    const DeskMasks& exact = exact_.at(number);
    change_(value, input, scene);
    const DeskMasks masks = desk_->masks(scene, *at.poses.world_from_camera);
    return {difference(masks.shadow, exact.shadow),
            difference(masks.shadow_on_virtual, exact.shadow_on_virtual),
            difference(masks.object, exact.object)};
  }

 private:
  std::shared_ptr<Desk> desk_;
  Change change_;
  std::map<std::size_t, DeskMasks> exact_;
};

PlannedSweep::Plan plan(const std::shared_ptr<Desk>& desk, SweepText text,
                        std::vector<std::string> values, std::size_t ways, Change change) {
  const auto trial = std::make_shared<MaskTrial>(desk, std::move(change));
  return {.text = std::move(text),
          .values = std::move(values),
          .methods = {"virtual shadow on real things", "real shadow on virtual things",
                      "virtual things that are seen"},
          .inputs = kInputs * ways,
          .run = [trial, ways](std::size_t value, std::size_t input) {
            return trial->run(value, input, ways);
          }};
}

bool is_phantom(const pipeline::Object& object) { return object.role == pipeline::Role::phantom; }

/// Millimetres; then comes the bounding box.
constexpr double kErrors_mm[] = {0, 0.2, 0.5, 1, 2, 5, 10, 20, 50};

/// Coarser models, each made once.
class CoarseModels {
 public:
  ModelPointer of(const ModelPointer& model, std::size_t value) {
    ModelPointer& coarse = known_[{model, value}];
    if (coarse) return coarse;
    if (value == std::size(kErrors_mm))
      coarse = bounding_box(*model);
    else if (kErrors_mm[value] > 0.0)
      coarse = std::make_shared<const pipeline::Model>(
          pipeline::simplify_mesh(*model, kErrors_mm[value] / 1000.0).model);
    else
      coarse = model;
    return coarse;
  }

 private:
  std::map<std::pair<ModelPointer, std::size_t>, ModelPointer> known_;
};

PlannedSweep::Plan coarse(const std::shared_ptr<Desk>& desk) {
  std::vector<std::string> values;
  for (const double error : kErrors_mm) values.push_back(fmt::format("{} mm", error));
  values.emplace_back("its box");
  const auto models = std::make_shared<CoarseModels>();
  return plan(desk,
              {"phantom-coarse", "Phantoms are too coarse",
               "Haller's method on the desk, four photographs and two pictures of the video with "
               "the hand-held card: every phantom is simplified within an error, and at last its "
               "bounding box.",
               "error of the phantoms", kOfEither, kExact},
              std::move(values), 1,
              [models](std::size_t value, std::size_t, pipeline::Scene& scene) {
                for (pipeline::Object& object : scene.objects)
                  if (is_phantom(object)) object.model = models->of(object.model, value);
              });
}

/// Centimetres.
constexpr double kShifts_cm[] = {0, 0.1, 0.2, 0.5, 1, 2, 5, 10};

PlannedSweep::Plan shifted(const std::shared_ptr<Desk>& desk) {
  std::vector<std::string> values;
  for (const double shift : kShifts_cm) values.push_back(fmt::format("{}", shift));
  return plan(
      desk,
      {"phantom-shifted", "Phantoms are in the wrong place",
       "All phantoms together are moved along each axis, forth or back; light, camera and "
       "virtual things stay.",
       "centimetres", kOfEither, kExact},
      std::move(values), kAxes, [](std::size_t value, std::size_t input, pipeline::Scene& scene) {
        const glm::vec3 by = direction(input) * static_cast<float>(kShifts_cm[value] / 100.0);
        for (pipeline::Object& object : scene.objects)
          if (is_phantom(object))
            object.world_from_model = glm::translate(glm::mat4(1.0f), by) * object.world_from_model;
      });
}

/// From what is far from the virtual things to all that they stand on.
constexpr std::string_view kMissing[] = {"none",   "shelf", "crate", "mug",  "books",
                                         "handle", "tin",   "house", "desk", "all"};

PlannedSweep::Plan missing(const std::shared_ptr<Desk>& desk) {
  return plan(
      desk,
      {"phantom-missing", "A phantom is missing",
       "One of the real things has no phantom: it hides nothing, casts nothing and receives "
       "nothing. The handle, a hand-held card with a virtual sphere on it, is in the "
       "video's pictures alone.",
       "what is missing", kOfEither, kExact},
      {std::begin(kMissing), std::end(kMissing)}, 1,
      [](std::size_t value, std::size_t, pipeline::Scene& scene) {
        const bool all = value + 1 == std::size(kMissing);
        std::erase_if(scene.objects, [&](const pipeline::Object& object) {
          return is_phantom(object) && (all || object.name == kMissing[value]);
        });
      });
}

/// Centimetres.
constexpr double kLightShifts_cm[] = {0, 0.5, 1, 2, 5, 10, 20, 30, 50};

PlannedSweep::Plan light(const std::shared_ptr<Desk>& desk) {
  std::vector<std::string> values;
  for (const double shift : kLightShifts_cm) values.push_back(fmt::format("{}", shift));
  return plan(
      desk,
      {"light-shifted", "The light is in the wrong place",
       "The bulb, 1.8 m from the desk's middle, is moved along each axis, forth or back; it "
       "sees all that it saw.",
       "centimetres", kOfEither, kExact},
      std::move(values), kAxes, [](std::size_t value, std::size_t input, pipeline::Scene& scene) {
        for (pipeline::Light& at : scene.lights)
          at.position += glm::vec4(direction(input), 0.0f) *
                         static_cast<float>(kLightShifts_cm[value] / 100.0);
      });
}

}  // namespace

void add_phantom_sweeps(Sweeps& sweeps, const std::shared_ptr<Desk>& desk) {
  for (PlannedSweep::Plan& plan :
       std::array{coarse(desk), shifted(desk), missing(desk), light(desk)})
    sweeps.push_back(std::make_unique<PlannedSweep>(std::move(plan)));
}

}  // namespace gnomon::apps::study
