#include "bench/growth.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/check.h"
#include "bench/statistics.h"
#include "bench/worker.h"

namespace gnomon::bench {
namespace {

constexpr int kTriangles[] = {1'000,   3'000,     10'000,    30'000,    100'000,
                              300'000, 1'000'000, 3'000'000, 10'000'000};
constexpr Size kSizes[] = {{640, 480},   {1280, 720},  {1920, 1080}, {2560, 1440},
                           {3840, 2160}, {5120, 2880}, {7680, 4320}};
/// Points at the end of a curve whose slope is stated beside that of all: there fixed costs are
/// small.
constexpr std::size_t kLast = 4;

double pixels(Size size) { return static_cast<double>(size.width) * size.height; }

double triangles(const pipeline::Scene& scene) {
  std::size_t count = 0;
  for (const pipeline::Object& object : scene.objects) {
    for (const pipeline::Part& part : object.model->parts) count += part.mesh.triangle_count();
  }
  return static_cast<double>(count);
}

/// llvmpipe by its faster method.
std::vector<Task> tasks(int threads) {
  return {{System::gnomon, Method::automatic, threads},
          {System::llvmpipe, Method::zpass, threads},
          {System::embree, Method::rays, threads}};
}

/// One x and what was measured there so far, a series and a memory a task.
struct Step {
  std::string subject;
  Size size;
  double x = 0.0;
  std::vector<Series> series{};
  std::vector<double> memory_mib{};
};

void measure_step(Step& step, const GrowthOptions& options, bool first_round) {
  fmt::print(stderr, "{} {}\n", step.subject, text(step.size));
  const std::vector<Task> all = tasks(options.threads);
  std::vector<std::unique_ptr<Worker>> workers;
  for (const Task& task : all) {
    workers.push_back(std::make_unique<Worker>(step.subject, step.size,
                                               std::span<const std::filesystem::path>{}, task));
  }
  const std::vector<Series> series = take_turns(workers, options.turns);
  step.series.resize(all.size());
  step.memory_mib.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    step.series[i].append(series[i]);
    // Before the check, which draws into a second set of buffers.
    const Memory memory = workers[i]->memory();
    step.memory_mib[i] = std::max(
        step.memory_mib[i], static_cast<double>(memory.peak - memory.loaded) / (1024.0 * 1024.0));
  }
  if (first_round) check(make_subject(step.subject, step.size), workers);
}

std::vector<Curve> measure_steps(std::vector<Step> steps, const GrowthOptions& options) {
  for (int round = 0; round < options.rounds; ++round) {
    for (Step& step : steps) measure_step(step, options, round == 0);
  }
  std::vector<Curve> curves;
  for (const Task& task : tasks(options.threads)) {
    const std::size_t i = curves.size();
    curves.push_back({.system = task.system, .method = task.method, .points = {}});
    for (const Step& step : steps) {
      curves.back().points.push_back(
          {.x = step.x, .ms = step.series[i].medians(), .memory_mib = step.memory_mib[i]});
    }
  }
  return curves;
}

nlohmann::json to_json(const std::vector<Curve>& curves, const char* x) {
  using nlohmann::json;
  json out = json::array();
  for (const Curve& curve : curves) {
    json points = json::array(), slopes = json::object();
    for (const Curve::Point& point : curve.points) {
      json entry{{x, point.x}, {"memory_mib", point.memory_mib}};
      for (const Stage stage : kStages) {
        if (const auto ms = point.ms[static_cast<std::size_t>(stage)]) {
          entry[std::string(name(stage)) + "_ms"] = *ms;
        }
      }
      points.push_back(std::move(entry));
    }
    for (const Stage stage : kStages) {
      const auto all = curve.slope(stage, curve.points.size()), last = curve.slope(stage, kLast);
      if (all && last) slopes[std::string(name(stage))] = {{"all", *all}, {"last", *last}};
    }
    out.push_back({{"system", name(curve.system)},
                   {"method", name(curve.method)},
                   {"points", points},
                   {"slopes", slopes}});
  }
  return out;
}

std::string table(const std::vector<Curve>& curves, const char* x) {
  std::string out;
  for (const Curve& curve : curves) {
    out += fmt::format("\n{} {}\n{:>12}{:>12}{:>12}{:>12}{:>12}{:>14}\n", name(curve.system),
                       name(curve.method), x, "scene ms", "volumes ms", "shadow ms", "frame ms",
                       "memory MiB");
    for (const Curve::Point& point : curve.points) {
      out += fmt::format("{:>12.0f}", point.x);
      for (const auto& ms : point.ms) out += fmt::format("{:>12.2f}", ms.value_or(0.0));
      out += fmt::format("{:>14.1f}\n", point.memory_mib);
    }
    for (const std::size_t last : {curve.points.size(), kLast}) {
      if (last > curve.points.size()) continue;
      out += fmt::format("slope of {:>3}", last);
      for (const Stage stage : kStages) {
        out += fmt::format("{:>12.2f}", curve.slope(stage, last).value_or(0.0));
      }
      out += '\n';
    }
  }
  return out;
}

}  // namespace

std::optional<double> Curve::slope(Stage stage, std::size_t last) const {
  std::vector<double> x, y;
  const std::size_t first = points.size() - std::min(last, points.size());
  for (std::size_t i = first; i < points.size(); ++i) {
    const auto ms = points[i].ms[static_cast<std::size_t>(stage)];
    if (!ms || *ms <= 0.0) continue;
    x.push_back(points[i].x);
    y.push_back(*ms);
  }
  if (x.size() < 2) return std::nullopt;
  return log_log_slope(x, y);
}

Growth measure_growth(const GrowthOptions& options) {
  std::vector<Step> by_triangles, by_pixels;
  for (const int count : kTriangles) {
    if (count > options.most_triangles) continue;
    const std::string subject = "grid-" + std::to_string(count);
    by_triangles.push_back({.subject = subject,
                            .size = kSizes[0],
                            .x = triangles(make_subject(subject, kSizes[0]).scene)});
  }
  for (const Size size : kSizes) {
    if (pixels(size) > options.most_pixels) continue;
    by_pixels.push_back({.subject = "tori-12", .size = size, .x = pixels(size)});
  }
  return {measure_steps(std::move(by_triangles), options),
          measure_steps(std::move(by_pixels), options)};
}

nlohmann::json to_json(const Growth& growth, const Report& now) {
  return {{"format", "gnomon bench growth"},
          {"version", 1},
          {"date", now.date},
          {"processor", now.processor},
          {"commit", now.commit},
          {"load", now.load},
          {"by_triangles", to_json(growth.by_triangles, "triangles")},
          {"by_pixels", to_json(growth.by_pixels, "pixels")}};
}

std::string table(const Growth& growth) {
  return table(growth.by_triangles, "triangles") + table(growth.by_pixels, "pixels");
}

}  // namespace gnomon::bench
