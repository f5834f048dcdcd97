// Models from files of any format that is read: glTF, and OBJ, OFF, STL, PLY and 3DS through
// assimp. What is read of each: docs/models.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/mesh.h"

namespace gnomon::ar {

/// A model, and one sentence for each thing of its file that was left out.
struct ModelFile {
  pipeline::Model model;
  std::vector<std::string> notes;
};

/// Reads a model in metres, in the file's own frame. The contents decide the format where they say
/// it (glTF, PLY, OFF, STL, 3DS), else the extension.
/// Throws InputError: a missing or damaged file, a format that is not read, a position that is not
/// finite, an index outside its mesh, no triangle at all. Holds afterwards: every mesh has normals;
/// every index is below the number of positions.
ModelFile load_model(const std::filesystem::path& path);

}  // namespace gnomon::ar
