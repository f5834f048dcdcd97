#include "apps/mesh_report.h"

#include <fmt/format.h>
#include <algorithm>

#include <array>

namespace gnomon::apps {
namespace {

using nlohmann::ordered_json;
using pipeline::MeshCheck;
using pipeline::MeshFinding;
using pipeline::MeshPlace;

struct Kind {
  const char* key;
  const char* words;
  MeshFinding MeshCheck::*finding;
  /// Stops a classical volume.
  bool fault;
};

constexpr std::array<Kind, 13> kKinds{{
    {"open_edges", "edges with one triangle only", &MeshCheck::open_edges, true},
    {"non_manifold_edges", "edges with more than two triangles", &MeshCheck::non_manifold_edges,
     true},
    {"misoriented_edges", "edges whose two triangles face opposite ways",
     &MeshCheck::misoriented_edges, true},
    {"non_finite_vertices", "vertices that are not finite", &MeshCheck::non_finite_vertices, true},
    {"outlines", "holes or outlines of sheets", &MeshCheck::outlines, false},
    {"unwelded_vertices", "vertices of open edges that nearly meet another",
     &MeshCheck::unwelded_vertices, false},
    {"t_junctions", "vertices of open edges inside another open edge", &MeshCheck::t_junctions,
     false},
    {"degenerate_triangles", "triangles without area", &MeshCheck::degenerate_triangles, false},
    {"duplicate_triangles", "triangles with the corners of an earlier one",
     &MeshCheck::duplicate_triangles, false},
    {"unreferenced_vertices", "vertices that no triangle uses", &MeshCheck::unreferenced_vertices,
     false},
    {"touching_vertices", "vertices where parts meet that share no edge",
     &MeshCheck::touching_vertices, false},
    {"inward_pieces", "closed pieces that face inwards (hollows, or inside out)",
     &MeshCheck::inward_pieces, false},
    {"self_intersections", "pairs of triangles that cut or touch each other",
     &MeshCheck::self_intersections, false},
}};

/// An outline of a thousand vertices is no line to read.
constexpr std::size_t kShownVertices = 6;

std::string place_text(const MeshPlace& place) {
  std::string text;
  for (const std::uint32_t t : place.triangles)
    text += fmt::format("{}{}", text.empty() ? "triangles " : ", ", t);
  if (!text.empty()) text += ": ";
  for (std::size_t i = 0; i < std::min(place.vertices.size(), kShownVertices); ++i) {
    const glm::vec3& p = place.positions_m[i];
    text += fmt::format("{}vertex {} ({:.6g} {:.6g} {:.6g})", i == 0 ? "" : ", ", place.vertices[i],
                        p.x, p.y, p.z);
  }
  if (place.vertices.size() > kShownVertices)
    text += fmt::format(" and {} more", place.vertices.size() - kShownVertices);
  return text;
}

ordered_json place_json(const MeshPlace& place) {
  ordered_json positions = ordered_json::array();
  for (const glm::vec3& p : place.positions_m) positions.push_back({p.x, p.y, p.z});
  return {{"triangles", place.triangles}, {"vertices", place.vertices}, {"positions_m", positions}};
}

}  // namespace

std::string verdict(const MeshCheck& check) {
  if (check.non_finite_vertices.count > 0) return "non-finite";
  if (check.edges == 0) return "empty";
  if (check.misoriented_edges.count > 0) return "misoriented";
  if (check.non_manifold_edges.count > 0) return "non-manifold";
  return check.open_edges.count > 0 ? "open" : "closed";
}

std::string report_text(const MeshCheck& check) {
  std::string text = fmt::format(
      "{} triangles, {} vertices ({} when welded), {} edges, {} pieces, V - E + F = {}\n"
      "diagonal {:.6g} m, tolerance {:.3g} m\n",
      check.triangles, check.vertices, check.welded_vertices, check.edges, check.pieces,
      check.euler_characteristic, check.diagonal_m, check.tolerance_m);
  for (const Kind& kind : kKinds) {
    const MeshFinding& finding = check.*kind.finding;
    if (finding.count == 0) continue;
    text += fmt::format("{} {} {}", kind.fault ? "FAULT" : "note ", finding.count, kind.words);
    if (kind.finding == &MeshCheck::outlines)
      text += fmt::format(", the longest of {} edges", check.longest_outline);
    text += '\n';
    for (const MeshPlace& place : finding.first) text += "        " + place_text(place) + '\n';
  }
  return text + (check.casts_classical_volume()
                     ? "closed, manifold, consistently oriented: casts a classical shadow volume\n"
                     : verdict(check) + ": casts no classical shadow volume\n");
}

ordered_json report_json(const MeshCheck& check) {
  ordered_json out{{"verdict", verdict(check)},
                   {"classical_volume", check.casts_classical_volume()},
                   {"triangles", check.triangles},
                   {"vertices", check.vertices},
                   {"welded_vertices", check.welded_vertices},
                   {"repeated_vertices", check.repeated_vertices},
                   {"edges", check.edges},
                   {"pieces", check.pieces},
                   {"euler_characteristic", check.euler_characteristic},
                   {"longest_outline", check.longest_outline},
                   {"diagonal_m", check.diagonal_m},
                   {"tolerance_m", check.tolerance_m}};
  for (const Kind& kind : kKinds) {
    const MeshFinding& finding = check.*kind.finding;
    if (kind.finding == &MeshCheck::self_intersections && !check.self_intersections_sought) {
      out[kind.key] = nullptr;
      continue;
    }
    ordered_json places = ordered_json::array();
    for (const MeshPlace& place : finding.first) places.push_back(place_json(place));
    out[kind.key] = {{"count", finding.count}, {"places", places}};
  }
  return out;
}

}  // namespace gnomon::apps
