// gnomon mesh repair: a mesh made fit for classical shadow volumes.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

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
#include "pipeline/mesh_repair.h"

namespace gnomon::apps {
namespace {

using nlohmann::ordered_json;
using pipeline::MeshRepairReport;

struct Options {
  std::filesystem::path mesh, out;
  pipeline::MeshRepairOptions repair;
  bool json = false;
};

struct Action {
  const char* key;
  const char* words;
  std::size_t MeshRepairReport::*count;
};

constexpr Action kActions[] = {
    {"non_finite_triangles", "triangles that are not finite removed",
     &MeshRepairReport::non_finite_triangles},
    {"collapsed_triangles", "triangles with a repeated corner removed",
     &MeshRepairReport::collapsed_triangles},
    {"flat_triangles", "triangles on a line removed", &MeshRepairReport::flat_triangles},
    {"duplicate_triangles", "repeated triangles removed", &MeshRepairReport::duplicate_triangles},
    {"welded_vertices", "vertices of open edges welded", &MeshRepairReport::welded_vertices},
    {"t_junctions", "open edges cut at a vertex on them", &MeshRepairReport::t_junctions},
    {"turned_triangles", "triangles turned", &MeshRepairReport::turned_triangles},
    {"parted_edges", "edges of more than two triangles parted", &MeshRepairReport::parted_edges},
    {"cut_edges", "edges of a one-sided surface opened", &MeshRepairReport::cut_edges},
    {"middle_vertices", "edges cut at their middle", &MeshRepairReport::middle_vertices},
    {"parted_vertices", "copies of vertices moved apart", &MeshRepairReport::parted_vertices},
    {"closed_holes", "holes closed", &MeshRepairReport::closed_holes},
    {"hole_triangles", "triangles added to close them", &MeshRepairReport::hole_triangles}};

void print_json(const Options& options, const MeshRepairReport& report,
                const pipeline::MeshCheck& before, const pipeline::MeshCheck& after) {
  ordered_json done;
  for (const Action& action : kActions) done[action.key] = report.*action.count;
  const ordered_json line{{"format", "gnomon-mesh-repair"},
                          {"version", 1},
                          {"file", options.mesh.string()},
                          {"out", options.out.string()},
                          {"tolerance_m", report.tolerance_m},
                          {"largest_move_m", report.largest_move_m},
                          {"done", done},
                          {"before", report_json(before)},
                          {"after", report_json(after)}};
  std::cout << line.dump(-1, ' ', false, ordered_json::error_handler_t::replace) << '\n';
}

void print_text(const MeshRepairReport& report, const pipeline::MeshCheck& before,
                const pipeline::MeshCheck& after) {
  const std::string faults = pipeline::describe(before);
  std::cout << fmt::format("before: {} triangles, {}{}{}\n", before.triangles, verdict(before),
                           faults.empty() ? "" : ": ", faults);
  for (const Action& action : kActions)
    if (report.*action.count > 0)
      std::cout << fmt::format("{:>8} {}\n", report.*action.count, action.words);
  std::cout << fmt::format("no vertex moved by more than {:.3g} m (tolerance {:.3g} m)\n",
                           report.largest_move_m, report.tolerance_m);
  const std::string left = pipeline::describe(after);
  std::cout << fmt::format("after: {} triangles, {}{}{}\n", after.triangles, verdict(after),
                           left.empty() ? "" : ": ", left);
  if (after.outlines.count > 0)
    std::cout << fmt::format(
        "{} holes or outlines are left, the longest of {} edges: see --max-hole\n",
        after.outlines.count, after.longest_outline);
}

void run(const Options& options) {
  check_mesh_output(options.mesh, options.out);
  const ar::ModelFile file = ar::load_model(options.mesh);
  const pipeline::MeshCheckOptions check{.tolerance_m = options.repair.tolerance_m,
                                         .self_intersections = false};
  const pipeline::MeshCheck before = pipeline::check_mesh(file.model, check);
  const pipeline::RepairedMesh repaired = pipeline::repair_mesh(file.model, options.repair);
  if (repaired.model.parts.empty())
    throw ar::InputError(
        fmt::format("{}: no triangle with an area is left", ar::one_line(options.mesh.string())));
  const pipeline::MeshCheck after = write_checked(options.out, repaired.model, check);
  if (options.json)
    print_json(options, repaired.report, before, after);
  else
    print_text(repaired.report, before, after);
}

}  // namespace

void add_mesh_repair(CLI::App& mesh) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      mesh.add_subcommand("repair", "Make a mesh cast classical shadow volumes, and say how");
  add_mesh_and_output(*command, options->mesh, options->out);
  command
      ->add_option("--tolerance", options->repair.tolerance_m,
                   "Metres that a vertex may move (default: 1e-5 of the bounding box's diagonal)")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--max-hole", options->repair.max_hole_edges,
                   "Edges of the longest hole that is closed (0: none)")
      ->check(CLI::Range(std::size_t{0}, pipeline::kMaxHoleEdges))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print one line of JSON (docs/mesh.md)");
  command->footer(
      "Welds vertices of open edges, cuts open edges at vertices on them, removes triangles "
      "without area and\n"
      "repeated ones, winds the rest one way and closed pieces outwards, parts edges of more than "
      "two triangles,\n"
      "closes holes. What is fit already keeps its bits. Longer holes stay open, and the last "
      "lines say so.\n"
      "\n"
      "Examples:\n"
      "  gnomon mesh repair scan.ply -o scan.glb\n"
      "  gnomon mesh repair house.obj -o house.glb --tolerance 0.001 --max-hole 100");
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::apps
