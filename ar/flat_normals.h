// Flat shading of a mesh that came without normals.
#pragma once

#include "pipeline/mesh.h"

namespace gnomon::ar {

/// Each corner becomes a vertex of its own with its triangle's unit normal (+z for a triangle
/// without area); positions keep their bits.
/// Preconditions: three indices a triangle, each below the number of positions.
void make_flat(pipeline::Mesh& mesh);

}  // namespace gnomon::ar
