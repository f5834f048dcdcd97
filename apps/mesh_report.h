// A mesh's check in words and as JSON (docs/mesh.md).
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pipeline/mesh_check.h"

namespace gnomon::apps {

/// "closed", or in one word what it is not: "open", "non-manifold", "misoriented", "empty",
/// "non-finite"; where several apply, the last of them.
std::string verdict(const pipeline::MeshCheck& check);

/// Counts and first places, a line each; what was not found is left out.
std::string report_text(const pipeline::MeshCheck& check);

/// {verdict, classical_volume, triangles, ..., FINDING: {count, places: [{triangles, vertices,
/// positions_m}]}}
nlohmann::ordered_json report_json(const pipeline::MeshCheck& check);

}  // namespace gnomon::apps
