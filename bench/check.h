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
  /// Hash of the first buffer (colour) of gnomon's plain methods, which all numbers of threads
  /// share.
  std::string hash;
};

/// What two pictures of a subject have in common. Throws std::runtime_error for different sizes.
Agreement compare(const Subject& subject, const Task& task, const Picture& own,
                  const Picture& other);

/// Throws std::runtime_error, with the figures, when more pixels differ than outlines explain.
void require_agreement(const Agreement& agreement);

/// Draws a frame in every worker and compares. z-pass and z-fail on infinite volumes must give the
/// same bytes of colour; the automatic method may move an outline by a rounding, because it ends
/// volumes where a vertex snaps elsewhere than on the way to infinity, and is held to the bound
/// that other systems are. Throws std::runtime_error that names what differs.
Checked check(const Subject& subject, const std::vector<std::unique_ptr<Worker>>& workers);

}  // namespace gnomon::bench
