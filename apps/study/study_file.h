// The file that names photographs with what is known of them, so that methods are charted against
// the real thing. Format "gnomon-study 1" (docs/accuracy.md).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::apps::study {

inline constexpr std::string_view kStudyFormat = "gnomon-study 1";

/// A photograph, the scene to be put into it, and a photograph of the same view with the scene's
/// virtual objects really there.
struct StudyPhotograph {
  std::string name;
  std::filesystem::path scene, photograph, truth;
  /// Where the objects take the light's direct part, and where they are seen; empty: not known.
  std::filesystem::path shadow_mask, object_mask;
  /// The capture folder with the light of a scene that has a [differential] table; else empty.
  std::filesystem::path capture;
};

struct Study {
  std::vector<StudyPhotograph> photographs;
  /// Scene files that are rendered, without a photograph.
  std::vector<std::filesystem::path> scenes;
};

/// Is it a study file, by its format, and not a scene? Throws ar::InputError when it cannot be
/// read.
bool is_study(const std::filesystem::path& file);

/// Throws ar::InputError "FILE:LINE: ...".
Study read_study(const std::filesystem::path& file);

}  // namespace gnomon::apps::study
