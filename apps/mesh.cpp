// gnomon mesh: is a mesh fit for shadow volumes, and what makes it so?
#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/mesh_commands.h"

namespace gnomon::apps {

void add_mesh(CLI::App& program) {
  CLI::App* mesh =
      program.add_subcommand("mesh", "Check, repair and simplify meshes for shadow volumes");
  mesh->require_subcommand(1);
  add_mesh_check(*mesh);
  add_mesh_repair(*mesh);
  add_mesh_simplify(*mesh);
  mesh->footer(
      "Read are .glb, .gltf, .obj, .off, .stl, .ply and .3ds (docs/models.md).\n"
      "\n"
      "Examples:\n"
      "  gnomon mesh check model.glb\n"
      "  gnomon mesh repair scan.ply -o scan.glb\n"
      "  gnomon mesh simplify statue.glb --error 0.5px --distance 2 -o statue_2m.glb\n"
      "  gnomon mesh COMMAND --help");
}

}  // namespace gnomon::apps
