#include "bench/check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace gnomon::bench {
namespace {

/// Part of the pixels that may differ: outlines of shadows and objects go through other pixels by a
/// rounding, and llvmpipe's closed volumes crack at single pixels. The worst that was seen is 4e-4,
/// of tori-64 at 160x120, where every 20th pixel is one of an outline.
constexpr double kMostDifferent = 1e-3;
/// By how much the shadowed parts of two pictures may differ: moved outlines go both ways.
constexpr double kMostShare = 5e-4;

/// What two systems must agree on at a pixel: in shadow or not, the count, the depth.
std::uint8_t answer(Kind kind, std::uint8_t value) {
  return kind == Kind::shadows ? static_cast<std::uint8_t>(value == 2) : value;
}

/// In shadow, counted, or nearer than the far plane.
bool marked(Kind kind, std::uint8_t value) {
  return kind == Kind::depth ? value != 255 : answer(kind, value) != 0;
}

double share(Kind kind, const Picture& picture) {
  const auto count = std::count_if(picture.begin(), picture.end(),
                                   [&](std::uint8_t value) { return marked(kind, value); });
  return static_cast<double>(count) / static_cast<double>(picture.size());
}

}  // namespace

Agreement compare(const Subject& subject, const Task& task, const Picture& own,
                  const Picture& other) {
  if (own.size() != other.size()) throw std::runtime_error("pictures of different sizes");
  Agreement out{.scene = subject.name,
                .size = subject.size,
                .system = task.system,
                .method = task.method,
                .threads = task.threads,
                .pixels = own.size(),
                .gnomon_share = share(subject.kind, own),
                .share = share(subject.kind, other)};
  for (std::size_t i = 0; i < own.size(); ++i) {
    out.differing += answer(subject.kind, own[i]) != answer(subject.kind, other[i]);
  }
  return out;
}

void require_agreement(const Agreement& a) {
  if (static_cast<double>(a.differing) <= kMostDifferent * static_cast<double>(a.pixels) &&
      std::abs(a.share - a.gnomon_share) <= kMostShare) {
    return;
  }
  throw std::runtime_error(
      fmt::format("{} {}: {} of {} pixels differ between gnomon and {} ({}); {:.3f} % of gnomon's "
                  "are in shadow and {:.3f} % of the other's",
                  a.scene, text(a.size), a.differing, a.pixels, name(a.system), name(a.method),
                  100.0 * a.gnomon_share, 100.0 * a.share));
}

namespace {

/// gnomon's hashes and pictures; returns the picture that others are compared with.
Picture check_own(const Subject& subject, const std::vector<std::unique_ptr<Worker>>& workers,
                  Checked& out) {
  Picture plain;
  for (const auto& worker : workers) {
    const Task& task = worker->task();
    if (task.system != System::gnomon) continue;
    const std::string hash = worker->hashes().at(0);
    if (!out.hash.empty() && hash != out.hash) {
      throw std::runtime_error(fmt::format(
          "{} {}: gnomon's picture differs between methods or threads: {} ({}, {} threads), {}",
          subject.name, text(subject.size), hash, name(task.method), task.threads, out.hash));
    }
    // The automatic method's counts are the plain ones' where a receiver is visible only.
    if (task.method != Method::automatic || plain.empty()) plain = worker->picture();
    out.hash = hash;
  }
  return plain;
}

}  // namespace

Checked check(const Subject& subject, const std::vector<std::unique_ptr<Worker>>& workers) {
  Checked out;
  for (const auto& worker : workers) worker->frame();
  const Picture own = check_own(subject, workers, out);
  for (const auto& worker : workers) {
    if (worker->task().system == System::gnomon || own.empty()) continue;
    out.agreements.push_back(compare(subject, worker->task(), own, worker->picture()));
  }
  for (const Agreement& agreement : out.agreements) require_agreement(agreement);
  return out;
}

}  // namespace gnomon::bench
