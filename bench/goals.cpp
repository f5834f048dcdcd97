#include "bench/goals.h"

#include <fmt/format.h>

namespace gnomon::bench {
namespace {

class Collector {
 public:
  explicit Collector(const std::vector<Row>& rows) : rows_(rows) {}

  void at(const std::string& scene, Size size, int threads) {
    place_ = {.scene = scene, .size = size, .threads = threads, .ratio_to_gnomon = {}};
  }

  /// A peer's time by gnomon's, at least `asked`.
  void ratio(System system, Method method, Stage stage, double asked) {
    const Row* row = find(rows_, place_, system, method, stage);
    if (!row || !row->ratio_to_gnomon) return;
    goals_.push_back(
        {.what = fmt::format("{} {}, {}: {} {} / gnomon {}", place_.scene, text(place_.size),
                             name(stage), name(system), name(method),
                             name(method == Method::rays ? Method::automatic : method)),
         .asked = fmt::format(">= {}", asked),
         .measured = fmt::format("{:.2f}", *row->ratio_to_gnomon),
         .met = *row->ratio_to_gnomon >= asked});
  }

  void milliseconds(Stage stage, double asked) {
    const Row* row = find(rows_, place_, System::gnomon, Method::automatic, stage);
    if (!row) return;
    goals_.push_back({.what = fmt::format("{} {}, {}: gnomon on {} thread(s)", place_.scene,
                                          text(place_.size), name(stage), place_.threads),
                      .asked = fmt::format("<= {} ms", asked),
                      .measured = fmt::format("{:.2f} ms", row->median_ms),
                      .met = row->median_ms <= asked});
  }

  void speed_up(double asked) {
    Row two_threads = place_;
    two_threads.threads = 2;
    const Row* one = find(rows_, place_, System::gnomon, Method::automatic, Stage::frame);
    const Row* two = find(rows_, two_threads, System::gnomon, Method::automatic, Stage::frame);
    if (!one || !two || two->median_ms <= 0.0) return;
    const double gain = one->median_ms / two->median_ms;
    goals_.push_back({.what = fmt::format("{} {}, frame: gnomon on 1 thread / on 2", place_.scene,
                                          text(place_.size)),
                      .asked = fmt::format(">= {}", asked),
                      .measured = fmt::format("{:.2f}", gain),
                      .met = gain >= asked});
  }

  std::vector<Goal> take() { return std::move(goals_); }

 private:
  const std::vector<Row>& rows_;
  Row place_;
  std::vector<Goal> goals_;
};

constexpr Size kSmall{640, 480}, kLarge{1920, 1080};

}  // namespace

std::vector<Goal> goals(const std::vector<Row>& rows) {
  Collector out(rows);
  for (const auto& [scene, size] : {std::pair("tori-12", kSmall), std::pair("tori-64", kLarge)}) {
    out.at(scene, size, 2);
    out.ratio(System::llvmpipe, Method::automatic, Stage::volumes, 15.0);
    out.ratio(System::llvmpipe, Method::zfail, Stage::volumes, 6.0);
    out.ratio(System::llvmpipe, Method::automatic, Stage::frame, 8.0);
    out.ratio(System::embree, Method::rays, Stage::frame, 4.0);
    out.at(scene, size, 1);
    out.speed_up(1.8);
  }
  out.at("layer-decided", kLarge, 1);
  out.ratio(System::llvmpipe, Method::zfail, Stage::volumes, 15.0);
  out.at("layer-random", kLarge, 1);
  out.ratio(System::llvmpipe, Method::zfail, Stage::volumes, 3.5);
  out.at("depth-12", {256, 256}, 1);
  out.milliseconds(Stage::frame, 0.6);
  return out.take();
}

std::string text(const std::vector<Goal>& goals) {
  std::string out;
  for (const Goal& goal : goals) {
    out += fmt::format("{:<66}{:>10}{:>10}{}\n", goal.what, goal.asked, goal.measured,
                       goal.met ? "" : "  missed");
  }
  return out;
}

}  // namespace gnomon::bench
