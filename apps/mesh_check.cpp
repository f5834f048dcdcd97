// gnomon mesh check: what a mesh lacks of casting a classical shadow volume.
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/mesh_commands.h"
#include "apps/mesh_report.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/model_file.h"
#include "pipeline/mesh_check.h"

namespace gnomon::apps {
namespace {

struct Options {
  std::filesystem::path mesh;
  pipeline::MeshCheckOptions check;
  bool no_self_intersections = false, json = false;
};

void run(Options& options) {
  const ar::ModelFile file = ar::load_model(options.mesh);
  options.check.self_intersections = !options.no_self_intersections;
  const pipeline::MeshCheck check = pipeline::check_mesh(file.model, options.check);
  if (options.json) {
    nlohmann::ordered_json line{
        {"format", "gnomon-mesh-check"}, {"version", 1}, {"file", options.mesh.string()}};
    line.update(report_json(check));
    line["reader_notes"] = file.notes;
    std::cout << line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
              << '\n';
  } else {
    for (const std::string& note : file.notes) std::cout << "note  " << ar::one_line(note) << '\n';
    std::cout << report_text(check);
  }
  if (!check.casts_classical_volume())
    throw ar::InputError(fmt::format("{}: {}: {}", ar::one_line(options.mesh.string()),
                                     verdict(check), pipeline::describe(check)));
}

}  // namespace

void add_mesh_check(CLI::App& mesh) {
  auto options = std::make_shared<Options>();
  CLI::App* command = mesh.add_subcommand(
      "check", "Say what a mesh lacks of casting a classical shadow volume, and where");
  command->add_option("mesh", options->mesh, "Mesh file")->required();
  command
      ->add_option("--tolerance", options->check.tolerance_m,
                   "Metres up to which vertices count as meant to be one (default: 1e-5 of the "
                   "bounding box's diagonal)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--places", options->check.places, "Places to print of each finding")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  command->add_flag("--no-self-intersections", options->no_self_intersections,
                    "Do not look for triangles that cut each other (it takes the most time)");
  command->add_flag("--json", options->json, "Print one line of JSON (docs/mesh.md)");
  command->footer(
      "Status 0: every edge is shared by two triangles in opposite directions. Status 1: it is not "
      "so, and\n"
      "one line on the error stream says what is wrong (FAULT in the report); or the file cannot "
      "be read,\n"
      "and nothing but that line is printed. Triangles and vertices count from 0 through all parts "
      "of the file.\n"
      "\n"
      "Examples:\n"
      "  gnomon mesh check model.glb\n"
      "  gnomon mesh check scan.ply --tolerance 0.0005 --places 20\n"
      "  gnomon mesh check model.obj --json");
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::apps
