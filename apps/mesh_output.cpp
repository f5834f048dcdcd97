#include "apps/mesh_output.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/model_file.h"
#include "ar/model_writer.h"

namespace gnomon::apps {

void add_mesh_and_output(CLI::App& command, std::filesystem::path& mesh,
                         std::filesystem::path& out) {
  command.add_option("mesh", mesh, "Mesh file")->required();
  command
      .add_option("-o,--out", out,
                  "File for the result: .glb, .gltf, .obj, .ply or .stl (the last three without "
                  "materials)")
      ->required();
}

void check_mesh_output(const std::filesystem::path& input, const std::filesystem::path& output) {
  ar::check_written_extension(output);
  std::error_code error;
  if (std::filesystem::equivalent(input, output, error))
    throw ar::InputError(
        fmt::format("{}: is the input itself; name another file", ar::one_line(output.string())));
}

pipeline::MeshCheck write_checked(const std::filesystem::path& output, const pipeline::Model& model,
                                  const pipeline::MeshCheckOptions& options) {
  const pipeline::MeshCheck meant = pipeline::check_mesh(model, options);
  ar::PendingFile file(output);
  ar::write_model(file.temporary(), model);
  pipeline::MeshCheck written =
      pipeline::check_mesh(ar::load_model(file.temporary()).model, options);
  if (pipeline::has_more_faults(written, meant))
    throw ar::InputError(fmt::format(
        "{}: cannot be written: this format rounds positions so that edges part ({}); .glb does "
        "not",
        ar::one_line(output.string()), pipeline::describe(written)));
  file.commit();
  return written;
}

}  // namespace gnomon::apps
