#include "pipeline/pass_budget.h"

#include <algorithm>
#include <cmath>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

/// What a frame counts after one more: a change of the scene is forgotten within some ten frames.
constexpr double kKeep = 0.85;
/// Of the budget: room for a frame that takes longer than the mean.
constexpr double kFill = 0.92;
constexpr std::size_t kFirst = 10;
/// The most that the number grows by in one frame.
constexpr double kGrowth = 2.0;

}  // namespace

PassBudget::PassBudget(double budget_ms, std::size_t most)
    : budget_ms_(budget_ms), most_(most), passes_(std::min(kFirst, most)) {
  raster::require(budget_ms > 0.0 && std::isfinite(budget_ms), "a budget is a positive time");
  raster::require(most > 0, "a budget is for one pass at least");
}

void PassBudget::add(std::size_t passes, double frame_ms) {
  if (!(frame_ms >= 0.0) || !std::isfinite(frame_ms)) return;
  const auto n = static_cast<double>(passes);
  for (double* sum : {&one_, &n_, &nn_, &t_, &nt_}) *sum *= kKeep;
  one_ += 1.0;
  n_ += n;
  nn_ += n * n;
  t_ += frame_ms;
  nt_ += n * frame_ms;
  // Frames of one number do not tell the two parts of their time apart: then all of it is taken to
  // grow with the passes, which is careful both ways.
  const double spread = one_ * nn_ - n_ * n_;
  double slope = n_ > 0.0 ? t_ / n_ : 0.0, base = 0.0;
  if (spread > 0.5 * one_ * one_) {
    const double fitted = (one_ * nt_ - n_ * t_) / spread;
    const double rest = (t_ - fitted * n_) / one_;
    if (fitted > 0.0 && rest >= 0.0) {
      slope = fitted;
      base = rest;
    }
  }
  if (!(slope > 0.0)) return;
  const double wanted = (budget_ms_ * kFill - base) / slope;
  const double most = std::min(static_cast<double>(most_), std::max(n, 1.0) * kGrowth);
  passes_ = static_cast<std::size_t>(std::clamp(std::floor(wanted), 1.0, std::max(1.0, most)));
}

}  // namespace gnomon::pipeline
