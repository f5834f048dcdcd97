#include "bench/check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace gnomon::bench {
namespace {

/// Pixels that may be in shadow for one system only. Outlines of shadows and objects go through
/// other pixels by a rounding, and llvmpipe's closed volumes crack at single pixels.
constexpr double kMostDifferent = 2e-3;
/// By how much the shadowed parts of two pictures may differ.
constexpr double kMostShare = 1e-3;

/// Shadow in a scene, coverage of a depth buffer, a count that is not 0 of a layer.
bool marked(Kind kind, std::uint8_t value) { return value >= (kind == Kind::shadows ? 2 : 1); }

double share(Kind kind, const Picture& picture) {
  const auto count = std::count_if(picture.begin(), picture.end(),
                                   [&](std::uint8_t value) { return marked(kind, value); });
  return static_cast<double>(count) / static_cast<double>(picture.size());
}

Agreement compare(const Subject& subject, const Task& task, const Picture& own,
                  const Picture& other) {
  if (own.size() != other.size()) throw std::runtime_error("pictures of different sizes");
  Agreement out{.scene = subject.name,
                .size = subject.size,
                .system = task.system,
                .method = task.method,
                .pixels = own.size(),
                .gnomon_share = share(subject.kind, own),
                .share = share(subject.kind, other)};
  for (std::size_t i = 0; i < own.size(); ++i) {
    out.differing += marked(subject.kind, own[i]) != marked(subject.kind, other[i]);
  }
  return out;
}

void require_agreement(const Agreement& a) {
  if (static_cast<double>(a.differing) <= kMostDifferent * static_cast<double>(a.pixels) &&
      std::abs(a.share - a.gnomon_share) <= kMostShare) {
    return;
  }
  throw std::runtime_error(fmt::format(
      "{} {}: {} of {} pixels are in shadow for gnomon or {} ({}) only; {:.3f} % and {:.3f} % are "
      "in shadow",
      a.scene, text(a.size), a.differing, a.pixels, name(a.system), name(a.method),
      100.0 * a.gnomon_share, 100.0 * a.share));
}

}  // namespace

Checked check(const Subject& subject, const std::vector<std::unique_ptr<Worker>>& workers) {
  Checked out;
  Picture own;
  for (const auto& worker : workers) {
    worker->frame();
    const Task& task = worker->task();
    if (task.system != System::gnomon) continue;
    const std::vector<std::string> hashes = worker->hashes();
    if (out.color_hash.empty()) {
      out.color_hash = hashes.at(0);
      own = worker->picture();
    }
    if (hashes.at(0) != out.color_hash) {
      throw std::runtime_error(fmt::format(
          "{} {}: gnomon's picture differs between methods or threads: {} ({}, {} threads), {}",
          subject.name, text(subject.size), hashes.at(0), name(task.method), task.threads,
          out.color_hash));
    }
  }
  for (const auto& worker : workers) {
    if (worker->task().system == System::gnomon || own.empty()) continue;
    out.agreements.push_back(compare(subject, worker->task(), own, worker->picture()));
    require_agreement(out.agreements.back());
  }
  return out;
}

}  // namespace gnomon::bench
