// What the tests of model readers ask of every model.
#pragma once

#include "pipeline/mesh.h"

namespace gnomon::ar::test {

/// Indices in range, finite positions, a unit normal and perhaps a colour a position.
void expect_sound_mesh(const pipeline::Mesh& mesh);

/// Six times the volume inside a closed mesh; positive if it is wound counter-clockwise outside.
double volume6(const pipeline::Model& model);

}  // namespace gnomon::ar::test
