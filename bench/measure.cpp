#include "bench/measure.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "bench/check.h"
#include "bench/turns.h"
#include "bench/worker.h"

namespace gnomon::bench {
namespace {

struct Place {
  std::string subject;
  Size size;
};

/// "layer" is a beginning of "layer-random"; "tori-1" is none of "tori-12".
bool begins(const std::string& name, const std::string& wanted) {
  return name == wanted || name.starts_with(wanted + "-");
}

std::vector<Place> places_of(const Options& options) {
  std::vector<Place> places;
  const auto add = [&](const std::string& name, const std::vector<Size>& usual) {
    for (const Size size : options.sizes.empty() ? usual : options.sizes) {
      places.push_back({name, size});
    }
  };
  if (options.scenes.empty()) {
    for (const UsualSubject& subject : usual_subjects()) add(subject.name, subject.sizes);
  }
  for (const std::string& wanted : options.scenes) {
    bool found = false;
    for (const UsualSubject& subject : usual_subjects()) {
      if (!begins(subject.name, wanted)) continue;
      add(subject.name, subject.sizes);
      found = true;
    }
    if (!found) {
      make_subject(wanted, {1, 1}, options.models);
      add(wanted, {{640, 480}});
    }
  }
  return places;
}

std::vector<Method> methods_of(System system, Kind kind) {
  if (kind == Kind::layer) return {Method::zfail};
  if (kind == Kind::depth) return {Method::automatic};
  if (system == System::embree) return {Method::rays};
  if (system == System::gnomon) return {Method::zpass, Method::zfail, Method::automatic};
  return {Method::zpass, Method::zfail};
}

std::vector<Task> tasks_of(const Options& options, Kind kind) {
  std::vector<Task> tasks;
  for (const int threads : options.threads) {
    for (const System system : options.systems) {
      if (system == System::embree && kind != Kind::shadows) continue;
      // softpipe has no threads.
      if (system == System::softpipe && threads != options.threads.front()) continue;
      for (const Method method : methods_of(system, kind)) {
        tasks.push_back({system, method, system == System::softpipe ? 1 : threads});
      }
    }
  }
  return tasks;
}

void add_rows(Report& report, const Place& place, const Task& task, const Series& series,
              int wanted) {
  const StageTimes medians = series.medians();
  for (const Stage stage : kStages) {
    const std::optional<double> ms = medians[static_cast<std::size_t>(stage)];
    if (!ms) continue;
    report.rows.push_back({.scene = place.subject,
                           .size = place.size,
                           .threads = task.threads,
                           .method = task.method,
                           .stage = stage,
                           .system = task.system,
                           .median_ms = *ms,
                           .ratio_to_gnomon = {}});
  }
  if (series.frames < wanted) {
    report.notes.push_back(fmt::format("{} {}: {} {} on {} threads is a median of {} frames",
                                       place.subject, text(place.size), name(task.system),
                                       name(task.method), task.threads, series.frames));
  }
}

void measure_place(Report& report, const Place& place, const Options& options) {
  const Subject subject = make_subject(place.subject, place.size, options.models);
  const std::vector<Task> tasks = tasks_of(options, subject.kind);
  std::vector<std::unique_ptr<Worker>> workers;
  for (const Task& task : tasks) {
    workers.push_back(std::make_unique<Worker>(place.subject, place.size, options.models, task));
  }
  const Checked checked = check(subject, workers);
  report.agreements.insert(report.agreements.end(), checked.agreements.begin(),
                           checked.agreements.end());
  if (!checked.hash.empty()) {
    report.hashes.push_back(place.subject + " " + text(place.size) + ": " + checked.hash);
  }
  for (const Agreement& a : checked.agreements) {
    fmt::print(stderr, "  {} {}: {} of {} pixels differ; shadow {:.3f} %, gnomon's {:.3f} %\n",
               name(a.system), name(a.method), a.differing, a.pixels, 100.0 * a.share,
               100.0 * a.gnomon_share);
  }
  const std::vector<Series> series = take_turns(workers, options.turns);
  for (std::size_t i = 0; i < workers.size(); ++i) {
    add_rows(report, place, tasks[i], series[i], options.turns.frames);
  }
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

}  // namespace

Report report_of_now() {
  Report report;
  const std::time_t now = std::time(nullptr);
  char date[32] = "";
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  report.date = date;
  report.processor = processor();
  const char* commit = std::getenv("GNOMON_COMMIT");
  report.commit = commit && *commit ? commit : "unknown";
  getloadavg(&report.load, 1);
  return report;
}

Report measure(const Options& options) {
  Report report = report_of_now();
  const std::vector<Place> places = places_of(options);
  for (std::size_t i = 0; i < places.size(); ++i) {
    fmt::print(stderr, "{} of {}: {} {}\n", i + 1, places.size(), places[i].subject,
               text(places[i].size));
    measure_place(report, places[i], options);
  }
  complete(report.rows);
  return report;
}

}  // namespace gnomon::bench
