// The golden scenes: frames that are kept as files in golden/frames, and whose bytes are kept as
// hashes in golden/manifest.json.
// Invariant: a scene is a function of nothing but its name. It takes models and numbers from the
// repository, makes its own picture in the photograph's place, and asks no tag, lens or codec.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "raster/frame_format.h"

namespace gnomon::golden {

struct Scene {
  /// Lower-case letters, digits and dashes.
  std::string name;
  /// Makes the scene's buffers and records its frame, which owns what it borrows.
  std::function<raster::RecordedFrame()> record;
  /// The scene that has the same frame and keeps its file; this one when empty.
  std::string frame_of = {};
  /// The last pass that is run: the first one whose label begins so; all of them when empty.
  std::string last_pass = {};
  /// The slow reference takes well under a second.
  bool quick = false;

  /// The frame file's name.
  const std::string& frame_name() const { return frame_of.empty() ? name : frame_of; }
  /// How many commands of the frame are run; more than it has where all are.
  std::size_t commands(const raster::Frame& frame) const;
};

/// All scenes; names are unique.
const std::vector<Scene>& scenes();

/// Frames with shadow maps, and with the rarer fixed-function states; part of scenes().
void add_shadow_map_scenes(std::vector<Scene>& all);
void add_state_scenes(std::vector<Scene>& all);

struct Size {
  int width, height;
};

struct Formats {
  raster::ColorFormat color = raster::ColorFormat::rgba8;
  raster::DepthFormat depth = raster::DepthFormat::d24;
};

/// Makes three buffers of one size.
raster::Targets add_targets(raster::RecordedFrame& out, Size size, Formats formats);

}  // namespace gnomon::golden
