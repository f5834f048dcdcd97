// A scene that methods are charted on: what can be set, and what each setting costs and gets wrong.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "apps/study/chart_point.h"
#include "ar/image.h"

namespace gnomon::apps::study {

/// A point, but for its job and the names of its pictures.
struct Charted {
  ChartPoint point;
  ar::Image picture, difference;
};

/// Cheap until the first run, which sets up what all settings share.
class ChartCase {
 public:
  virtual ~ChartCase() = default;
  virtual std::string name() const = 0;
  virtual std::size_t settings() const = 0;
  /// Measures the error, and times that many frames after one that is not timed. The errors are the
  /// same for every number of frames.
  virtual Charted run(std::size_t setting, int frames) = 0;
};

}  // namespace gnomon::apps::study
