// A scene that methods are charted on, and the methods with a setting that contend there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/study/chart_point.h"
#include "ar/image.h"

namespace gnomon::apps::study {

/// A point without times, job and names of pictures; and its pictures.
struct Charted {
  ChartPoint point;
  ar::Image picture, difference;
};

/// A method with a setting on a scene.
class Contender {
 public:
  virtual ~Contender() = default;
  /// What it gets wrong.
  virtual Charted measure() = 0;
  /// Milliseconds of one frame.
  virtual double frame_ms() = 0;
};

/// Cheap to make: contenders() sets up what they share.
class ChartCase {
 public:
  virtual ~ChartCase() = default;
  virtual std::string name() const = 0;
  /// Always the same ones in the same order. They refer to the case.
  virtual std::vector<std::unique_ptr<Contender>> contenders() = 0;
};

}  // namespace gnomon::apps::study
