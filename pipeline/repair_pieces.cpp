// Whole pieces of an oriented surface: turned outwards, or removed where they repeat another; and
// vertices moved apart where welding by position would join what was parted.
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/disjoint_sets.h"
#include "pipeline/repair_surface.h"

namespace gnomon::pipeline::repair {
namespace {

struct Piece {
  std::vector<std::uint32_t> triangles;
  bool closed = true;
  double volume6 = 0.0;
  std::size_t turned = 0;
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

/// Ascending by first triangle.
std::vector<Piece> pieces_of(const Surface& surface) {
  const auto count = static_cast<std::uint32_t>(surface.triangles.size());
  DisjointSets sets(count);
  for (std::uint32_t half = 0; half < 3 * count; ++half)
    if (surface.mate[half] != kNone) sets.unite(half / 3, surface.mate[half] / 3);
  std::vector<std::uint32_t> number(count, kNone);
  std::vector<Piece> pieces;
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::uint32_t root = sets.find(t);
    if (root == t) {
      number[t] = static_cast<std::uint32_t>(pieces.size());
      pieces.emplace_back();
    }
    Piece& piece = pieces[number[root]];
    piece.triangles.push_back(t);
    piece.turned += surface.triangles[t].turned;
    for (std::uint32_t half = 3 * t; half < 3 * t + 3; ++half) {
      piece.closed = piece.closed && surface.mate[half] != kNone;
      piece.low = glm::min(piece.low, surface.at(surface.from(half)));
      piece.high = glm::max(piece.high, surface.at(surface.from(half)));
    }
  }
  for (Piece& piece : pieces) {
    const glm::dvec3 middle = 0.5 * (piece.low + piece.high);
    for (const std::uint32_t t : piece.triangles) {
      const auto& v = surface.triangles[t].vertex;
      piece.volume6 += glm::dot(surface.at(v[0]) - middle,
                                glm::cross(surface.at(v[1]) - middle, surface.at(v[2]) - middle));
    }
  }
  return pieces;
}

/// How often the piece winds around the point (van Oosterom and Strackee 1983).
double winding(const Surface& surface, const Piece& piece, const glm::dvec3& point) {
  double angle = 0.0;
  for (const std::uint32_t t : piece.triangles) {
    const auto& v = surface.triangles[t].vertex;
    const glm::dvec3 a = surface.at(v[0]) - point, b = surface.at(v[1]) - point,
                     c = surface.at(v[2]) - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                 glm::dot(b, c) * la +
                                                                 glm::dot(c, a) * lb);
  }
  return angle / (4.0 * std::acos(-1.0));
}

bool inside(const Piece& inner, const Piece& outer) {
  return glm::all(glm::greaterThan(inner.low, outer.low)) &&
         glm::all(glm::lessThan(inner.high, outer.high));
}

/// Does it lie in another closed piece, and was it wound inwards as it came?
bool is_hollow(const Surface& surface, const std::vector<Piece>& pieces, const Piece& piece) {
  if (2 * piece.turned > piece.triangles.size()) return false;
  const glm::dvec3 point = surface.at(surface.triangles[piece.triangles[0]].vertex[0]);
  return std::ranges::any_of(pieces, [&](const Piece& other) {
    return &other != &piece && other.closed && inside(piece, other) &&
           std::abs(winding(surface, other, point)) > 0.5;
  });
}

/// The places of a piece's triangles, each from its smallest on, ascending.
std::vector<std::array<std::uint32_t, 3>> places_of(const Surface& surface, const Piece& piece) {
  std::vector<std::array<std::uint32_t, 3>> places;
  for (const std::uint32_t t : piece.triangles) {
    std::array<std::uint32_t, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = surface.place[surface.triangles[t].vertex[k]];
    std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
    places.push_back(p);
  }
  std::sort(places.begin(), places.end());
  return places;
}

void remove_triangles(Surface& surface, const std::vector<bool>& removed) {
  std::vector<std::uint32_t> moved(surface.triangles.size(), kNone);
  std::uint32_t kept = 0;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    if (!removed[t]) moved[t] = kept++;
  std::vector<std::uint32_t> mate;
  for (std::uint32_t half = 0; half < surface.mate.size(); ++half) {
    if (removed[half / 3]) continue;
    const std::uint32_t m = surface.mate[half];
    mate.push_back(m == kNone ? kNone : 3 * moved[m / 3] + m % 3);
  }
  std::uint32_t t = 0;
  std::erase_if(surface.triangles, [&](const Triangle&) { return removed[t++]; });
  surface.mate = std::move(mate);
}

/// Turning swaps corners 1 and 2: half-edge 0 becomes the third, and the third the first.
void turn_triangles(Surface& surface, const Piece& piece) {
  const auto turned = [](std::uint32_t half) { return half - half % 3 + (5 - half % 3) % 3; };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> mates;
  for (const std::uint32_t t : piece.triangles) {
    surface.triangles[t].turn();
    for (std::uint32_t half = 3 * t; half < 3 * t + 3; ++half)
      mates.emplace_back(turned(half),
                         surface.mate[half] == kNone ? kNone : turned(surface.mate[half]));
  }
  for (const auto& [half, mate] : mates) surface.mate[half] = mate;
}

}  // namespace

void turn_outwards(Surface& surface, MeshRepairReport& report) {
  const std::vector<Piece> pieces = pieces_of(surface);
  for (const Piece& piece : pieces)
    if (piece.closed && piece.volume6 < 0.0 && !is_hollow(surface, pieces, piece))
      turn_triangles(surface, piece);
  std::set<std::vector<std::array<std::uint32_t, 3>>> known;
  std::vector<bool> removed(surface.triangles.size(), false);
  std::size_t count = 0;
  for (const Piece& piece : pieces) {
    if (!piece.closed || known.insert(places_of(surface, piece)).second) continue;
    for (const std::uint32_t t : piece.triangles) removed[t] = true;
    count += piece.triangles.size();
  }
  if (count > 0) remove_triangles(surface, removed);
  report.duplicate_triangles += count;
}

namespace {

using PositionBits = std::array<std::uint32_t, 3>;

PositionBits bits_of(const glm::vec3& p) {
  return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
          std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

/// Vertices, of those at one place, whose edges would be welded with those of another: all but the
/// first vertex of each place.
std::vector<std::uint32_t> vertices_to_part(const Surface& surface,
                                            const std::vector<std::uint32_t>& place) {
  std::vector<std::uint32_t> first(surface.positions.size(), kNone);
  for (std::uint32_t v = 0; v < surface.positions.size(); ++v)
    if (first[place[v]] == kNone) first[place[v]] = v;
  // By places, then by vertices: edges of one pair of places but several pairs of vertices collide.
  using Key = std::array<std::uint32_t, 4>;
  std::vector<Key> edges;
  for (std::uint32_t half = 0; half < 3 * surface.triangles.size(); ++half) {
    std::uint32_t u = surface.from(half), v = surface.to(half);
    if (std::pair(place[v], v) < std::pair(place[u], u)) std::swap(u, v);
    edges.push_back({place[u], place[v], u, v});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<std::uint32_t> parted;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto same = [&](std::size_t j) {
      return j < edges.size() && edges[j][0] == edges[i][0] && edges[j][1] == edges[i][1];
    };
    if (!same(i + 1) && !(i > 0 && same(i - 1))) continue;
    for (const std::uint32_t v : {edges[i][2], edges[i][3]})
      if (first[place[v]] != v) parted.push_back(v);
  }
  std::sort(parted.begin(), parted.end());
  parted.erase(std::unique(parted.begin(), parted.end()), parted.end());
  return parted;
}

/// The sum of the ways from each vertex to the middles of its triangles.
std::vector<glm::dvec3> ways_into_fans(const Surface& surface) {
  std::vector<glm::dvec3> ways(surface.positions.size(), glm::dvec3(0.0));
  for (const Triangle& t : surface.triangles) {
    const glm::dvec3 middle =
        (surface.at(t.vertex[0]) + surface.at(t.vertex[1]) + surface.at(t.vertex[2])) / 3.0;
    for (const std::uint32_t v : t.vertex) ways[v] += middle - surface.at(v);
  }
  return ways;
}

/// Near `position`, at most `distance` from it, and nowhere else taken.
glm::vec3 free_position(const glm::dvec3& position, const glm::dvec3& way, double distance,
                        const std::set<PositionBits>& taken) {
  const double length = glm::length(way);
  const glm::dvec3 inwards = length > 0.0 ? way / length : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 tries[] = {inwards,    {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                              {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  for (const double share : {1.0, 0.8, 0.6, 0.9, 0.7, 0.5})
    for (const glm::dvec3& direction : tries) {
      const glm::vec3 moved(position + 0.95 * share * distance * direction);
      if (!taken.contains(bits_of(moved))) return moved;
    }
  return glm::vec3(position);
}

}  // namespace

void part_vertices(Surface& surface, double distance, MeshRepairReport& report) {
  const std::vector<glm::dvec3> ways = ways_into_fans(surface);
  const std::vector<glm::vec3> before = surface.positions;
  std::set<std::uint32_t> moved;
  // A moved vertex may be at the place of another by chance; then it moves once more, from where it
  // was.
  for (int round = 0; round < 4; ++round) {
    std::map<PositionBits, std::uint32_t> numbers;
    std::vector<std::uint32_t> place;
    for (const glm::vec3& p : surface.positions)
      place.push_back(numbers.try_emplace(bits_of(p), static_cast<std::uint32_t>(numbers.size()))
                          .first->second);
    const std::vector<std::uint32_t> parted = vertices_to_part(surface, place);
    if (parted.empty()) break;
    std::set<PositionBits> taken;
    for (const auto& [bits, number] : numbers) taken.insert(bits);
    for (const std::uint32_t v : parted) {
      surface.positions[v] = free_position(glm::dvec3(before[v]), ways[v], distance, taken);
      taken.insert(bits_of(surface.positions[v]));
      moved.insert(v);
    }
  }
  report.parted_vertices += moved.size();
}

}  // namespace gnomon::pipeline::repair
