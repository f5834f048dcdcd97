// What gnomon fit leaves of the examples, and what that costs in photographs that it never saw:
// those with the virtual objects really there. Prints docs/fit.md's tables.
// Usage: measure_fit SOURCES LIT_SCENE [BOUND or SCENE...], where SOURCES is the project's folder
// and LIT_SCENE what gnomon capture examples/soft --out LIT_SCENE wrote.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/fit.h"
#include "ar/flip.h"
#include "ar/image_file.h"
#include "ar/metrics.h"
#include "ar/scene_writer.h"
#include "ar/session.h"
#include "capture_json.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

const fs::path kOut = fs::temp_directory_path() / fmt::format("gnomon_measure_fit_{}", getpid());
/// Values by which a pixel of a soft shadow differs from the empty room's.
constexpr int kSeen = 6;

/// A scene, and the folders of photographs of it with the object really there.
struct Subject {
  std::string scene;
  std::vector<std::string> truths;
};

const std::vector<Subject> kDesk = {{"01_torus_on_house", {"01_torus_on_house"}},
                                    {"02_house_on_torus", {"02_house_on_torus"}},
                                    {"03_tin_on_torus", {"03_tin_on_torus"}},
                                    {"04_torus_and_sphere_on_tin", {"04_torus_and_sphere_on_tin"}}};
/// The box was fitted half a metre above the floor; the others are places that it was not fitted
/// at.
const std::vector<Subject> kSoft = {
    {"box", {"04_box_lifted_50cm", "03_box_lifted_25cm", "02_box_lifted_10cm", "01_box_lifted_0"}},
    {"suzanne", {"08_suzanne"}}};

struct Truth {
  double rmse = 0.0, iou = 0.0, flip = 0.0;
};

/// Set where either is.
ar::Image either(const ar::Image& a, const ar::Image& b) {
  ar::Image out{a.width, a.height, 1, {}};
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      out.pixels.push_back(std::max(a.at(x, y)[0], b.at(x, y)[0]) >= 128 ? 255 : 0);
  return out;
}

/// Where a picture differs from the empty room, but for objects.
ar::Image changed(const ar::Image& picture, const ar::Image& room, const ar::Image& objects) {
  ar::Image out{picture.width, picture.height, 1, {}};
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      int most = 0;
      for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(picture.at(x, y)[c] - room.at(x, y)[c]));
      out.pixels.push_back(most >= kSeen && objects.at(x, y)[0] == 0 ? 255 : 0);
    }
  }
  return out;
}

ar::Augmented draw(const ar::SceneFile& scene, const ar::Image& photograph) {
  ar::Session session(scene, photograph.width, photograph.height, {.still = true});
  ar::SessionResult result = session.process(photograph, 0.0);
  if (!result.augmented) throw ar::InputError("nothing was placed");
  return std::move(*result.augmented);
}

Truth compare(const ar::Image& picture, const ar::Image& mask, const ar::Image& true_picture,
              const ar::Image& true_mask, const ar::Image& objects) {
  const ar::Image region = either(true_mask, objects);
  return {.rmse = ar::difference(picture, true_picture, &true_mask).rmse,
          .iou = ar::mask_iou(mask, true_mask).value_or(0.0),
          .flip = ar::mean_error(ar::flip(true_picture, picture), &region)};
}

Truth desk_truth(const ar::SceneFile& scene, const fs::path& folder, const ar::Image& photograph) {
  const ar::Augmented drawn = draw(scene, photograph);
  const ar::Image true_mask = either(ar::read_image(folder / "shadow_mask.png"),
                                     ar::read_image(folder / "shadow_on_virtual.png"));
  return compare(drawn.composite, either(drawn.shadow_mask, drawn.shadow_on_virtual),
                 ar::read_image_rgb(folder / "photo.png"), true_mask,
                 ar::read_image(folder / "object_mask.png"));
}

Truth soft_truth(ar::SceneFile scene, const fs::path& folder, const ar::Image& photograph) {
  scene.objects[0].body_from_object =
      matrix_of(load_json(folder / "pose.json")["objects"][0]["world_from_object"]);
  const ar::Augmented drawn = draw(scene, photograph);
  const ar::Image truth = ar::read_image_rgb(folder / "photo.png"),
                  covered = ar::read_image(folder / "object_mask.png");
  const ar::Image objects = either(covered, drawn.object_mask);
  return compare(drawn.composite, changed(drawn.composite, photograph, objects), truth,
                 changed(truth, photograph, objects), objects);
}

std::string arrow(const std::string& before, const std::string& after) {
  return before == after ? before : before + " → " + after;
}

void measure(const Subject& subject, const fs::path& sources, const std::string& set,
             const fs::path& lit_scene, const std::string& bound) {
  const fs::path folder = sources / "examples" / set, truths = sources / "tests/data" / set;
  ar::SceneFile given = ar::read_scene(folder / (subject.scene + ".toml"));
  const bool soft = given.differential.has_value();
  if (soft) given.differential->lit_scene = lit_scene;
  const ar::Image photograph = ar::read_image_rgb(folder / "background.png");
  ar::Fitter fitter(
      given, {{"background.png", photograph}},
      {.bound = ar::parse_error_bound(bound), .repeat = 3, .lit_scene = soft ? lit_scene : ""});
  const ar::FitResult result = fitter.search();
  fs::remove_all(kOut);
  fs::create_directories(kOut);
  ar::write_fit_scene(result.given, result.fitted, kOut, kOut);
  const ar::SceneFile fitted = ar::read_scene(kOut / "scene.toml");
  const auto error = [&](const ar::FitState& state) {
    return ar::describe_error(ar::parse_error_bound(bound).unit, state.error);
  };
  const auto &before = result.before, &after = result.after;
  std::cout << fmt::format(
      "fit | {} | {} | {} | {} | {} | {} | {:.1f} → {:.1f} |\n", subject.scene, bound,
      arrow(error(before), error(after)),
      soft ? arrow(fmt::format("{}", before.passes), fmt::format("{}", after.passes))
           : arrow(fmt::format("{}", before.totals.phantom_triangles),
                   fmt::format("{}", after.totals.phantom_triangles)),
      arrow(fmt::format("{}", before.totals.casting_triangles),
            fmt::format("{}", after.totals.casting_triangles)),
      result.drawn, before.ms, after.ms);
  for (const std::string& name : subject.truths) {
    const auto truth = [&](const ar::SceneFile& scene) {
      return soft ? soft_truth(scene, truths / name, photograph)
                  : desk_truth(scene, truths / name, photograph);
    };
    const Truth a = truth(given), b = truth(fitted);
    std::cout << fmt::format(
        "truth | {} | {} | {:.2f} → {:.2f} | {:.3f} → {:.3f} | {:.4f} → {:.4f} |\n", name, bound,
        a.rmse, b.rmse, a.iou, b.iou, a.flip, b.flip);
  }
  std::cout << std::flush;
  for (const ar::FitFinding& finding : result.findings)
    if (finding.outcome != "kept")
      std::cerr << fmt::format("{} {}: {}: {} -> {} ({})\n", subject.scene, bound, finding.item,
                               finding.given, finding.taken, finding.outcome);
}

}  // namespace
}  // namespace gnomon

int main(int argc, char** argv) {
  using namespace gnomon;
  if (argc < 3) {
    std::cerr << "usage: measure_fit SOURCES LIT_SCENE [BOUND or SCENE...]\n";
    return 1;
  }
  std::vector<std::string> bounds, scenes;
  for (const std::string argument : std::span(argv + 3, argv + argc))
    (argument.ends_with("px") || argument.ends_with("flip") ? bounds : scenes).push_back(argument);
  if (bounds.empty()) bounds = {"0.5px", "1px", "2px"};
  const auto wanted = [&](const Subject& subject) {
    return scenes.empty() || std::ranges::find(scenes, subject.scene) != scenes.end();
  };
  try {
    for (const std::string& bound : bounds) {
      for (const Subject& subject : kSoft)
        if (wanted(subject)) measure(subject, argv[1], "soft", argv[2], bound);
      for (const Subject& subject : kDesk)
        if (wanted(subject)) measure(subject, argv[1], "desk", {}, bound);
    }
  } catch (const std::exception& error) {
    std::cerr << "measure_fit: " << error.what() << '\n';
    return 1;
  }
  fs::remove_all(kOut);
  return 0;
}
