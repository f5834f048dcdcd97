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
  /// Hash of the first buffer (colour), which all of gnomon's methods and numbers of threads share.
  std::string hash;
};

/// What two pictures of a subject have in common. Throws std::runtime_error for different sizes.
Agreement compare(const Subject& subject, const Task& task, const Picture& own,
                  const Picture& other);

/// Throws std::runtime_error, with the figures, when more pixels differ than outlines explain.
void require_agreement(const Agreement& agreement);

/// Draws a frame in every worker and compares. All methods must give the
/// same bytes of colour. Throws std::runtime_error that names what differs.
Checked check(const Subject& subject, const std::vector<std::unique_ptr<Worker>>& workers);

}  // namespace gnomon::bench
