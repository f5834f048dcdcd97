#include <algorithm>
#include <iostream>

#include <fmt/format.h>

#include "apps/ar_arguments.h"
#include "apps/ar_json.h"
#include "apps/output_folder.h"
#include "apps/photograph.h"
#include "apps/step_pictures.h"
#include "ar/error.h"
#include "ar/frame_file.h"
#include "ar/image_file.h"

namespace gnomon::apps {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

int count_set(const ar::Image& mask) {
  return static_cast<int>(std::ranges::count(mask.pixels, std::uint8_t{255}));
}

void report_left_out(const ar::SessionResult& result) {
  for (const std::string& name : result.left_out)
    std::cerr << "gnomon: note: object '" << name
              << "' is left out: its body's tags are not seen\n";
}

}  // namespace

void run_still(const ArArguments& arguments) {
  const ar::SceneFile scene = ar::read_scene(arguments.scene);
  const ar::Image picture = ar::read_image_rgb(arguments.image);
  check_folder(arguments.out);
  refuse_to_replace(arguments.image, arguments.out / "composite.png");
  std::vector<fs::path> inputs = ar::input_files(scene);
  inputs.push_back(arguments.image);
  check_frame_target(arguments.save_frame, inputs);
  ar::Session session(scene, picture.width, picture.height, arguments.session);
  const ar::SessionResult result = augment_photograph(session, picture, arguments.image);
  const ar::Augmented& augmented = *result.augmented;
  make_folder(arguments.out);
  ar::write_png(arguments.out / "composite.png", augmented.composite);
  ar::write_png(arguments.out / "shadow_mask.png", augmented.shadow_mask);
  ar::write_png(arguments.out / "shadow_on_virtual.png", augmented.shadow_on_virtual);
  ar::write_png(arguments.out / "object_mask.png", augmented.object_mask);
  // Differential shadows count no volumes that stay in the stencil buffer.
  if (!augmented.stencil_counts.pixels.empty())
    ar::write_png(arguments.out / "stencil_counts.png", augmented.stencil_counts);
  if (arguments.steps) write_steps(arguments.out, augmented.steps);
  if (!arguments.save_frame.empty()) ar::write_frame(arguments.save_frame, augmented.frame);

  if (arguments.as_json) {
    json line = {{"image", arguments.image.string()},
                 {"tags", detections_json(result.track)},
                 {"poses", poses_json(result)},
                 {"left_out", result.left_out},
                 {"view", {session.view().width(), session.view().height()}},
                 {"passes", passes_json(augmented)},
                 {"pixels",
                  {{"shadow", count_set(augmented.shadow_mask)},
                   {"shadow_on_virtual", count_set(augmented.shadow_on_virtual)},
                   {"object", count_set(augmented.object_mask)}}},
                 {"ms", stages_json(result)}};
    if (result.differential) line["differential"] = differential_json(*result.differential);
    // A file's name is bytes; those that are no UTF-8 are replaced.
    std::cout << line.dump(-1, ' ', false, json::error_handler_t::replace) << '\n';
    return;
  }
  report_left_out(result);
  std::cout << fmt::format(
      "{}: {} tags, {} passes, {} px of virtual objects, {} px of shadow on real "
      "surfaces, {} px of real shadow on virtual ones\n",
      arguments.image.string(), result.track.detections.size(), augmented.passes.size(),
      count_set(augmented.object_mask), count_set(augmented.shadow_mask),
      count_set(augmented.shadow_on_virtual));
  if (const auto& d = result.differential)
    std::cout << fmt::format(
        "{} shadows for {} sources whose light may be hidden from {} patches{}\n", d->shadows,
        d->occluded_sources, d->receivers,
        d->left_out > 0
            ? fmt::format("; {} left out: an object is around them or too near", d->left_out)
            : "");
  std::cout << "wrote " << (arguments.out / "composite.png").string() << " and its masks\n";
}

}  // namespace gnomon::apps
