// The commands of `gnomon mesh`, each in a file of its own.
#pragma once

namespace CLI {
class App;
}

namespace gnomon::apps {

/// gnomon mesh check M: what a mesh lacks of casting a classical shadow volume.
void add_mesh_check(CLI::App& mesh);

/// gnomon mesh repair M -o N: what makes it cast them.
void add_mesh_repair(CLI::App& mesh);

/// gnomon mesh simplify M --error E -o N: fewer triangles within an error.
void add_mesh_simplify(CLI::App& mesh);

}  // namespace gnomon::apps
