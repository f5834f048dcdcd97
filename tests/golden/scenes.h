// The golden scenes: frames whose bytes are kept as hashes in golden/manifest.json.
// Invariant: a scene is a function of nothing but its name. It takes models and numbers from the
// repository, makes its own picture in the photograph's place, and asks no tag, lens or codec.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "raster/frame.h"
#include "raster/random_frames.h"

namespace gnomon::golden {

using random_frames::Targets;

struct Scene {
  /// Letters, digits and dashes.
  std::string name;
  int width = 0, height = 0;
  raster::ColorFormat color = raster::ColorFormat::rgba8;
  raster::DepthFormat depth = raster::DepthFormat::d24;
  /// Records the scene's frame for targets of its size and formats; the frame owns what it borrows,
  /// the targets apart.
  std::function<raster::Frame(Targets&)> record;
  /// The last pass that is run: the first one whose label begins so; all of them when empty.
  std::string last_pass = {};
  /// The slow reference takes well under a second.
  bool quick = false;

  Targets make_targets() const { return {width, height, color, depth}; }
  /// How many commands of the frame are run.
  std::size_t commands(const raster::Frame& frame) const;
};

/// All scenes; names are unique.
const std::vector<Scene>& scenes();

}  // namespace gnomon::golden
