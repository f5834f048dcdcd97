#include "apps/study/chart_cases.h"

#include <set>
#include <string>
#include <utility>

#include "apps/study/generated_views.h"
#include "apps/study/photograph_case.h"
#include "apps/study/ray_case.h"
#include "apps/study/room_case.h"
#include "apps/study/study_file.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/pinhole_view.h"
#include "ar/render_scene.h"
#include "ar/scene_models.h"

namespace gnomon::apps::study {

namespace {

constexpr int kWidth = 640, kHeight = 480;

/// What a pinhole camera in the photograph's place sees.
View pinhole_view(const StudyPhotograph& photograph, int threads) {
  PlacedPhotograph at = place(photograph, threads);
  if (at.scene.lights.size() != 1)
    throw ar::InputError(photograph.scene.string() + ": one light can be charted");
  at.scene.lights[0].samples = 1;
  const ar::PinholeView view(at.lens, 1);
  return {photograph.name, at.scene,
          view.camera(at.world_from_camera, at.file.near_m, at.file.far_m)};
}

/// What the scene file's camera sees of one of its lights.
View rendered_view(const ar::SceneFile& file, std::size_t light) {
  ar::PlacedScene placed = ar::place_scene(file, ar::load_models(file), 0, 0);
  pipeline::Light& chosen = placed.scene.lights.at(light);
  chosen.samples = 1;
  placed.scene.lights = {chosen};
  return {"", std::move(placed.scene), placed.camera};
}

void add_scene(const std::filesystem::path& path, int threads,
               std::vector<std::unique_ptr<ChartCase>>& cases) {
  const ar::SceneFile file = ar::read_scene(path);
  if (file.lights.empty()) throw ar::InputError(path.string() + ": no [[light]] to chart");
  for (std::size_t i = 0; i < file.lights.size(); ++i)
    cases.push_back(std::make_unique<RayCase>(
        path.stem().string() + ", " + file.lights[i].name,
        [file, i] { return rendered_view(file, i); }, threads));
}

void add_photograph(const StudyPhotograph& photograph, CapturedRooms& rooms, int threads,
                    std::vector<std::unique_ptr<ChartCase>>& cases) {
  if (!photograph.capture.empty()) {
    cases.push_back(std::make_unique<RoomCase>(photograph, rooms, threads));
    return;
  }
  cases.push_back(std::make_unique<PhotographCase>(photograph, threads));
  cases.push_back(std::make_unique<RayCase>(
      photograph.name + ", light's shadow",
      [photograph, threads] { return pinhole_view(photograph, threads); }, threads));
}

void require_different_names(const std::vector<std::unique_ptr<ChartCase>>& cases) {
  std::set<std::string> names;
  for (const auto& one : cases)
    if (!names.insert(one->name()).second)
      throw ar::InputError("two scenes are called '" + ar::one_line(one->name()) + "'");
}

}  // namespace

std::vector<std::unique_ptr<ChartCase>> chart_cases(const std::vector<std::filesystem::path>& files,
                                                    bool generated, CapturedRooms& rooms,
                                                    int threads) {
  std::vector<std::unique_ptr<ChartCase>> cases;
  for (const std::filesystem::path& file : files) {
    if (!is_study(file)) {
      add_scene(file, threads, cases);
      continue;
    }
    const Study study = read_study(file);
    for (const StudyPhotograph& photograph : study.photographs)
      add_photograph(photograph, rooms, threads, cases);
    for (const std::filesystem::path& scene : study.scenes) add_scene(scene, threads, cases);
  }
  if (generated) {
    for (View& view : generated_views(kWidth, kHeight)) {
      std::string name = view.name;
      cases.push_back(std::make_unique<RayCase>(
          std::move(name), [view = std::move(view)] { return view; }, threads));
    }
  }
  require_different_names(cases);
  return cases;
}

}  // namespace gnomon::apps::study
