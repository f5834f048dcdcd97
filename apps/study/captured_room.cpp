#include "apps/study/captured_room.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "ar/scene_light.h"

namespace gnomon::apps::study {

using pipeline::ShadowMask;
using pipeline::ShadowPrecision;

namespace {

constexpr std::size_t kAll = 100'000;

class Settings {
 public:
  ar::DifferentialSettings& add(const char* family, std::size_t passes, const char* more = "") {
    const std::string n = passes == kAll ? "all" : std::to_string(passes);
    all.push_back({fmt::format("{} passes{}", n, more), family, {}});
    ar::DifferentialSettings& settings = all.back().settings;
    settings.method.take.passes = passes;
    settings.masks = false;
    return settings;
  }
  std::vector<DifferentialSetting> all;
};

void add_precisions(Settings& out) {
  for (const std::size_t passes : {std::size_t{50}, kAll}) {
    out.add("precision", passes, ", dithered").method.take.precision = ShadowPrecision::dithered;
    out.add("precision", passes, ", float values").method.take.precision = ShadowPrecision::values;
    out.add("precision", passes, ", float radiance").method.take.precision =
        ShadowPrecision::radiance;
  }
}

void add_casters(Settings& out) {
  out.add("reduced casters", 50, ", casters of all triangles").occluder_triangles = 0;
  for (const std::size_t triangles : {100, 20}) {
    ar::DifferentialSettings& settings = out.add("reduced casters", 50);
    settings.occluder_triangles = triangles;
    out.all.back().name += fmt::format(", casters of {}", triangles);
  }
}

void add_papers(Settings& out) {
  out.add("the paper's choices", 50, ", black objects").method.take.returned_light = false;
  out.add("the paper's choices", 50, ", one amount").method.take.by_share = false;
  for (const std::size_t passes : {10, 20, 50}) {
    ar::DifferentialSettings& paper = out.add("the paper's choices", passes, ", as in the paper");
    paper.method.take.returned_light = paper.method.take.by_share = false;
    paper.method.take.whole_clusters = true;
    paper.method.mask = ShadowMask::map;
    paper.light.drop_pruned = true;
  }
}

bool same_camera(const ar::CameraModel& a, const ar::CameraModel& b) {
  const auto numbers = [](const ar::CameraModel& c) {
    return std::tuple(c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.lens, c.distortion);
  };
  return numbers(a) == numbers(b);
}

}  // namespace

std::vector<DifferentialSetting> differential_settings() {
  Settings out;
  for (const std::size_t passes : {std::size_t{1}, std::size_t{2}, std::size_t{5}, std::size_t{10},
                                   std::size_t{20}, std::size_t{50}, std::size_t{100}, kAll})
    out.add("volumes", passes);
  for (const std::size_t passes :
       {std::size_t{5}, std::size_t{10}, std::size_t{20}, std::size_t{50}, std::size_t{100}})
    out.add("maps", passes, ", maps of 256").method.mask = ShadowMask::map;
  for (const int size : {64, 1024}) {
    ar::DifferentialSettings& settings = out.add("maps", 50);
    settings.method.mask = ShadowMask::map;
    settings.method.map_size = size;
    out.all.back().name += fmt::format(", maps of {}", size);
  }
  add_precisions(out);
  add_casters(out);
  add_papers(out);
  ar::DifferentialSettings& most = out.add("precision", kAll, " of all power, float radiance");
  most.method.take.precision = ShadowPrecision::radiance;
  most.light.transfer.power_share = 1.0;
  return std::move(out.all);
}

CapturedRoom::CapturedRoom(const std::filesystem::path& capture, int threads)
    : light_(std::make_shared<const pipeline::LitScene>(
          ar::find_scene_light(ar::read_capture(capture), {.threads = threads}).scene)),
      threads_(threads) {}

ar::DifferentialAugmenter& CapturedRoom::augmenter(const DifferentialSetting& setting,
                                                   const PlacedPhotograph& photograph) {
  const ar::SceneFile& file = photograph.file;
  const auto same = [&](const std::unique_ptr<Made>& made) {
    return made->name == setting.name && same_camera(made->camera, photograph.lens.camera()) &&
           made->world_from_camera == photograph.world_from_camera && made->near_m == file.near_m &&
           made->far_m == file.far_m;
  };
  const auto known = std::ranges::find_if(made_, same);
  if (known != made_.end()) return (*known)->augmenter;
  ar::DifferentialSettings settings = setting.settings;
  settings.threads = threads_;
  settings.near_m = file.near_m;
  settings.far_m = file.far_m;
  made_.push_back(std::make_unique<Made>(Made{
      setting.name, photograph.lens.camera(), photograph.world_from_camera, file.near_m, file.far_m,
      ar::DifferentialAugmenter(photograph.lens, light_, photograph.world_from_camera, settings)}));
  return made_.back()->augmenter;
}

CapturedRoom& CapturedRooms::room(const std::filesystem::path& capture) {
  std::unique_ptr<CapturedRoom>& room = rooms_[std::filesystem::weakly_canonical(capture)];
  if (!room) room = std::make_unique<CapturedRoom>(capture, threads_);
  return *room;
}

}  // namespace gnomon::apps::study
