// Which tags a scene knows and what each is fixed to.
// A tag's frame: origin at its centre, x right and y up as printed, z out of its face, metres. Its
// size is the edge of the black border.
#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

namespace gnomon::ar {

/// A tag by family ("tag36h11", "DICT_4X4_50", or the name of a custom dictionary) and number.
struct TagId {
  std::string family;
  int number = 0;
  auto operator<=>(const TagId&) const = default;
};

/// A tag on a rigid body: the world itself, or something that moves.
struct PlacedTag {
  TagId id;
  double size_m = 0.0;
  glm::dmat4 body_from_tag{1.0};
};

/// A rigid body that carries one or more tags.
struct TaggedBody {
  /// Empty for the world.
  std::string name;
  std::vector<PlacedTag> tags;
};

/// The world's tags and those of each moving body. An id appears once.
struct TagLayout {
  TaggedBody world;
  std::vector<TaggedBody> bodies;
};

}  // namespace gnomon::ar
