// Is what is timed the right picture? gnomon's bytes against its own slow path, its shadows against
// those of other systems. A wrong picture has no speed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/report.h"
#include "bench/worker.h"

namespace gnomon::bench {

struct Checked {
  std::vector<Agreement> agreements;
  /// The hashes of gnomon's colour, which all its methods and numbers of threads share.
  std::string color_hash;
};

/// Draws a frame in every worker and compares. Throws std::runtime_error that names what differs.
Checked check(const Subject& subject, const std::vector<std::unique_ptr<Worker>>& workers);

}  // namespace gnomon::bench
