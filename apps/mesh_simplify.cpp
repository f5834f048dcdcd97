// gnomon mesh simplify: fewer triangles within an error that a picture does not show.
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/mesh_commands.h"
#include "apps/mesh_output.h"
#include "apps/mesh_report.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/model_file.h"
#include "pipeline/mesh_check.h"
#include "pipeline/mesh_simplify.h"

namespace gnomon::apps {
namespace {

using nlohmann::ordered_json;

struct Options {
  std::filesystem::path mesh, out;
  std::string error;
  double distance_m = 0.0, fov_y_deg = 50.0, rows = 1080.0;
  bool json = false;
};

/// "0.5px" with the camera's numbers, or "0.002m".
double error_in_metres(const Options& options) {
  std::size_t end = 0;
  double value = 0.0;
  try {
    value = std::stod(options.error, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  const std::string unit = options.error.substr(end);
  if (end == 0 || (unit != "px" && unit != "m") || !std::isfinite(value) || !(value > 0.0))
    throw ar::InputError(fmt::format(
        "mesh simplify: --error {}: give a positive number with px or m", options.error));
  if (unit == "m") return value;
  if (!(options.distance_m > 0.0))
    throw ar::InputError("mesh simplify: --error in px needs --distance, in metres");
  return pipeline::metres_of_pixels(value, options.distance_m,
                                    options.fov_y_deg * std::numbers::pi / 180.0, options.rows);
}

void print_text(const pipeline::MeshSimplifyReport& r, const pipeline::MeshCheck& after) {
  std::cout << fmt::format("{} triangles of {} within {:.4g} m\n", r.triangles_after,
                           r.triangles_before, r.error_m);
  if (r.given_up)
    std::cout << "every try had faults or lay outside the error: the mesh is as it was\n";
  else
    std::cout << fmt::format("measured distance {:.4g} m, the simplifier was given {:.4g} m\n",
                             r.measured_error_m, r.given_error_m);
  if (r.faulty_tries + r.distant_tries > 0)
    std::cout << fmt::format(
        "backed off: {} tries had faults that the mesh has not, {} lay outside the error\n",
        r.faulty_tries, r.distant_tries);
  if (r.parted_edges > 0)
    std::cout << fmt::format("{} edges of more than two triangles were parted\n", r.parted_edges);
  const std::string left = pipeline::describe(after);
  std::cout << fmt::format("after: {}{}{}\n", verdict(after), left.empty() ? "" : ": ", left);
}

void print_json(const Options& options, const pipeline::MeshSimplifyReport& r,
                const pipeline::MeshCheck& before, const pipeline::MeshCheck& after) {
  const ordered_json line{{"format", "gnomon-mesh-simplify"},
                          {"version", 1},
                          {"file", options.mesh.string()},
                          {"out", options.out.string()},
                          {"error_m", r.error_m},
                          {"given_error_m", r.given_error_m},
                          {"measured_error_m", r.measured_error_m},
                          {"triangles_before", r.triangles_before},
                          {"triangles_after", r.triangles_after},
                          {"faulty_tries", r.faulty_tries},
                          {"distant_tries", r.distant_tries},
                          {"parted_edges", r.parted_edges},
                          {"given_up", r.given_up},
                          {"before", report_json(before)},
                          {"after", report_json(after)}};
  std::cout << line.dump(-1, ' ', false, ordered_json::error_handler_t::replace) << '\n';
}

void run(const Options& options) {
  const double error_m = error_in_metres(options);
  check_mesh_output(options.mesh, options.out);
  const ar::ModelFile file = ar::load_model(options.mesh);
  const pipeline::MeshCheckOptions check{.self_intersections = false};
  const pipeline::MeshCheck before = pipeline::check_mesh(file.model, check);
  const pipeline::SimplifiedMesh simple = pipeline::simplify_mesh(file.model, error_m);
  const pipeline::MeshCheck after = write_checked(options.out, simple.model, check);
  if (options.json)
    print_json(options, simple.report, before, after);
  else
    print_text(simple.report, after);
}

}  // namespace

void add_mesh_simplify(CLI::App& mesh) {
  auto options = std::make_shared<Options>();
  CLI::App* command = mesh.add_subcommand(
      "simplify", "Leave out triangles as far as an error in pixels or metres allows");
  add_mesh_and_output(*command, options->mesh, options->out);
  command
      ->add_option("--error", options->error,
                   "How far the surface may be off: pixels (0.5px, with --distance) or metres "
                   "(0.002m)")
      ->required();
  command
      ->add_option("--distance", options->distance_m,
                   "Metres from the camera to the mesh's nearest point")
      ->check(CLI::PositiveNumber);
  command->add_option("--fov", options->fov_y_deg, "The camera's vertical field of view, degrees")
      ->check(CLI::Range(0.1, 179.0))
      ->capture_default_str();
  command->add_option("--height", options->rows, "The picture's height in pixels")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print one line of JSON (docs/mesh.md)");
  command->footer(
      "The result is measured against the mesh and checked as mesh check does. Where it lies "
      "outside the error\n"
      "or has faults that the mesh has not, a smaller error is tried, and the output says so. "
      "Textures are left out.\n"
      "An object of a scene takes it as shadow_model, to cast while the mesh itself is drawn.\n"
      "\n"
      "Examples:\n"
      "  gnomon mesh simplify statue.glb --error 0.5px --distance 2 -o statue_2m.glb\n"
      "  gnomon mesh simplify scan.ply --error 0.002m -o phantom.glb");
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::apps
