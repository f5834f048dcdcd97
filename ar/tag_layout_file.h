// Layouts of tags that come from outside, and the rules that every layout keeps.
#pragma once

#include <filesystem>
#include <string>

#include "ar/tag_layout.h"

namespace gnomon::ar {

/// Errors: InputError beginning with `source` and naming the tag or body when a size is not
/// positive and finite, a transform is not a rotation and translation, a number is negative, a tag
/// appears twice, a moving body has no tag, no name or another's name.
void check_layout(const TagLayout& layout, const std::string& source);

/// Reads apriltag_ros's tags.yaml. A bundle becomes a moving body of its name (or "bundle_N"), a
/// standalone tag a body of its own ("tag_ID" unless named); a standalone tag that is also in a
/// bundle belongs to the bundle. The body named `world` becomes the world.
/// Errors: InputError for what is not such a file, and all of check_layout's.
TagLayout read_tags_yaml(const std::filesystem::path& file, const std::string& family = "tag36h11",
                         const std::string& world = "");

}  // namespace gnomon::ar
