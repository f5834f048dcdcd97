// A cube of edge 2 about the origin, wound counter-clockwise from outside, in each format that is
// read through assimp.
#pragma once

#include <map>
#include <string>

namespace gnomon::ar::test {

/// File names and contents: "cube.obj", "cube.off", "ascii.stl", "binary.stl", "ascii.ply",
/// "binary.ply", "cube.3ds".
std::map<std::string, std::string> cube_files();

}  // namespace gnomon::ar::test
