#include "ar/tag_layout_file.h"

#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "ar/yaml_input.h"

namespace gnomon::ar {
namespace {

using std::filesystem::path;

constexpr std::size_t kMaxTags = 10000;
constexpr double kMaxSize_m = 1000.0;

bool is_rigid(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r])) return false;
    }
  }
  constexpr double kTolerance = 1e-4;
  const glm::dmat3 rotation(m);
  const glm::dmat3 identity = glm::transpose(rotation) * rotation;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      if (std::abs(identity[c][r] - (c == r ? 1.0 : 0.0)) > kTolerance) return false;
    }
  }
  return glm::determinant(rotation) > 0.0 && m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 &&
         m[3][3] == 1.0;
}

void check_body(const TaggedBody& body, const std::string& source, std::set<TagId>& seen) {
  for (const PlacedTag& tag : body.tags) {
    const std::string place =
        fmt::format("{}: tag {} {:.60}", source, tag.id.number, tag.id.family);
    if (tag.id.family.empty()) throw InputError(place + ": has no family");
    if (tag.id.number < 0) throw InputError(place + ": its number is negative");
    if (!(tag.size_m > 0.0 && tag.size_m <= kMaxSize_m)) {
      throw InputError(fmt::format("{}: its size is {} m, not above 0 and at most {} m", place,
                                   tag.size_m, kMaxSize_m));
    }
    if (!is_rigid(tag.body_from_tag)) {
      throw InputError(place + ": its pose is not a rotation and a translation");
    }
    if (!seen.insert(tag.id).second) throw InputError(place + ": appears twice");
  }
}

TagId id_of(const path& file, const YAML::Node& tag, const std::string& place,
            const std::string& family) {
  return {family,
          yaml::integer(file, tag["id"], place + ".id", 0, std::numeric_limits<int>::max())};
}

double number_or(const path& file, const YAML::Node& map, const std::string& place, const char* key,
                 double fallback) {
  const YAML::Node node = map[key];
  return node.IsDefined() ? yaml::number(file, node, place + "." + key) : fallback;
}

PlacedTag bundle_tag(const path& file, const YAML::Node& tag, const std::string& place,
                     const std::string& family) {
  if (!tag.IsMap()) yaml::fail(file, tag, place, "expected a map with id and size");
  PlacedTag placed{id_of(file, tag, place, family),
                   yaml::number(file, tag["size"], place + ".size")};
  const glm::dquat q(number_or(file, tag, place, "qw", 1.0), number_or(file, tag, place, "qx", 0.0),
                     number_or(file, tag, place, "qy", 0.0),
                     number_or(file, tag, place, "qz", 0.0));
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  // People write four digits.
  constexpr double kTolerance = 0.01;
  if (!(std::abs(length - 1.0) <= kTolerance)) {
    yaml::fail(file, tag, place, fmt::format("its quaternion has length {:g}, not 1", length));
  }
  placed.body_from_tag = glm::mat4_cast(glm::normalize(q));
  placed.body_from_tag[3] =
      glm::dvec4(number_or(file, tag, place, "x", 0.0), number_or(file, tag, place, "y", 0.0),
                 number_or(file, tag, place, "z", 0.0), 1.0);
  return placed;
}

/// The list under `key`, empty when absent.
YAML::Node list_of(const path& file, const YAML::Node& map, const std::string& key,
                   const std::string& place) {
  const YAML::Node node = map[key];
  if (!node.IsDefined() || node.IsNull()) return YAML::Node(YAML::NodeType::Sequence);
  if (!node.IsSequence()) yaml::fail(file, node, place, "expected a list");
  if (node.size() > kMaxTags) {
    yaml::fail(file, node, place, fmt::format("more than {} entries", kMaxTags));
  }
  return node;
}

std::string name_or(const path& file, const YAML::Node& map, const std::string& place,
                    std::string fallback) {
  const YAML::Node node = map["name"];
  return node.IsDefined() ? yaml::text(file, node, place + ".name", 200) : fallback;
}

std::vector<TaggedBody> read_bundles(const path& file, const YAML::Node& root,
                                     const std::string& family, std::set<TagId>& bundled) {
  std::vector<TaggedBody> bodies;
  const YAML::Node bundles = list_of(file, root, "tag_bundles", "tag_bundles");
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    const std::string place = fmt::format("tag_bundles[{}]", i);
    const YAML::Node bundle = bundles[i];
    if (!bundle.IsMap()) yaml::fail(file, bundle, place, "expected a map with name and layout");
    TaggedBody body{name_or(file, bundle, place, fmt::format("bundle_{}", i)), {}};
    const YAML::Node layout = list_of(file, bundle, "layout", place + ".layout");
    for (std::size_t t = 0; t < layout.size(); ++t) {
      body.tags.push_back(
          bundle_tag(file, layout[t], fmt::format("{}.layout[{}]", place, t), family));
      bundled.insert(body.tags.back().id);
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace

void check_layout(const TagLayout& layout, const std::string& source) {
  std::set<TagId> seen;
  check_body(layout.world, source, seen);
  std::set<std::string> names;
  for (const TaggedBody& body : layout.bodies) {
    if (body.name.empty()) throw InputError(source + ": a moving body has no name");
    if (!names.insert(body.name).second) {
      throw InputError(fmt::format("{}: body '{:.60}': appears twice", source, body.name));
    }
    if (body.tags.empty()) {
      throw InputError(fmt::format("{}: body '{:.60}': has no tags", source, body.name));
    }
    check_body(body, source, seen);
  }
}

TagLayout read_tags_yaml(const path& file, const std::string& family, const std::string& world) {
  const YAML::Node root = yaml::load(file);
  if (!root["standalone_tags"].IsDefined() && !root["tag_bundles"].IsDefined()) {
    throw InputError(
        fmt::format("{}: neither standalone_tags nor tag_bundles is there", file.string()));
  }
  std::set<TagId> bundled;
  std::vector<TaggedBody> bodies = read_bundles(file, root, family, bundled);
  const YAML::Node standalone = list_of(file, root, "standalone_tags", "standalone_tags");
  for (std::size_t i = 0; i < standalone.size(); ++i) {
    const std::string place = fmt::format("standalone_tags[{}]", i);
    const YAML::Node tag = standalone[i];
    if (!tag.IsMap()) yaml::fail(file, tag, place, "expected a map with id and size");
    const PlacedTag placed{id_of(file, tag, place, family),
                           yaml::number(file, tag["size"], place + ".size")};
    if (bundled.contains(placed.id)) continue;
    bodies.push_back(
        {name_or(file, tag, place, fmt::format("tag_{}", placed.id.number)), {placed}});
  }
  TagLayout layout;
  bool found = world.empty();
  for (TaggedBody& body : bodies) {
    if (!world.empty() && body.name == world) {
      layout.world.tags = std::move(body.tags);
      found = true;
    } else {
      layout.bodies.push_back(std::move(body));
    }
  }
  if (!found) {
    throw InputError(fmt::format("{}: no bundle or tag is named '{:.60}'", file.string(), world));
  }
  check_layout(layout, file.string());
  return layout;
}

}  // namespace gnomon::ar
