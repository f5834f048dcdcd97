// A mesh that a command writes: it is read back and checked before it takes its name.
#pragma once

#include <filesystem>

#include "pipeline/mesh.h"
#include "pipeline/mesh_check.h"

namespace CLI {
class App;
}

namespace gnomon::apps {

/// Adds what a command is called with that makes a mesh from another: the one and --out.
void add_mesh_and_output(CLI::App& command, std::filesystem::path& mesh,
                         std::filesystem::path& out);

/// Before any work: can the format be written, and is the output not the input? Throws
/// ar::InputError if not.
void check_mesh_output(const std::filesystem::path& input, const std::filesystem::path& output);

/// Writes the model beside `output`, reads it, and renames it only if it has no more faults than
/// the model. Returns the check of what was read. Throws ar::InputError and leaves what was there.
pipeline::MeshCheck write_checked(const std::filesystem::path& output, const pipeline::Model& model,
                                  const pipeline::MeshCheckOptions& options);

}  // namespace gnomon::apps
