#include "apps/study/stability.h"

#include <algorithm>
#include <string>

#include "apps/output_folder.h"
#include "apps/study/part_file.h"
#include "apps/study/stability_page.h"
#include "ar/file.h"
#include "raster/check.h"

namespace gnomon::apps::study {

namespace fs = std::filesystem;

namespace {

StabilityColumn run_job(Sweep& sweep, std::size_t value) {
  StabilityColumn column{.value = sweep.values()[value], .inputs = sweep.inputs()};
  const std::size_t methods = sweep.methods().size();
  column.outcomes.resize(methods);
  column.worst.resize(methods);
  for (std::size_t input = 0; input < column.inputs; ++input) {
    const std::vector<Outcome> outcomes = sweep.run(value, input);
    raster::require(outcomes.size() == methods, "a sweep gives one outcome a method");
    for (std::size_t i = 0; i < methods; ++i) {
      column.outcomes[i].wrong += outcomes[i].wrong;
      column.outcomes[i].of += outcomes[i].of;
      column.outcomes[i].not_finite += outcomes[i].not_finite;
      column.worst[i] = std::max(column.worst[i], outcomes[i].share());
    }
  }
  return column;
}

}  // namespace

std::size_t jobs_of(const Sweeps& sweeps) {
  std::size_t jobs = 0;
  for (const auto& sweep : sweeps) jobs += sweep->values().size();
  return jobs;
}

StabilityPart run_stability(const Sweeps& sweeps, const Shard& shard, const fs::path& out,
                            const std::function<void(std::size_t)>& progress) {
  make_folder(out);
  const fs::path file = begin_part(out, kStabilityName, shard);
  StabilityPart part{.shard = shard, .jobs = jobs_of(sweeps)};
  std::size_t job = 0;
  for (std::size_t number = 0; number < sweeps.size(); ++number) {
    Sweep& sweep = *sweeps[number];
    part.sweeps.push_back(sweep.text());
    part.methods.push_back(sweep.methods());
    for (std::size_t value = 0; value < sweep.values().size(); ++value, ++job) {
      if (!shard.has(job)) continue;
      part.columns.push_back(run_job(sweep, value));
      part.columns.back().job = job;
      part.columns.back().sweep = number;
      progress(part.columns.size());
    }
  }
  write_stability_part(file, part);
  return part;
}

void write_stability(const fs::path& out, const StabilityPart& whole) {
  const std::string name(kStabilityName);
  ar::write_file(out / (name + ".csv"), stability_csv(whole));
  ar::write_file(out / (name + ".html"), stability_page(whole));
}

StabilityPart merge_stability(const fs::path& out) {
  std::vector<StabilityPart> parts;
  for (const fs::path& file : find_parts(out, kStabilityName))
    parts.push_back(read_stability_part(file));
  const StabilityPart whole = merge_stability_parts(parts);
  write_stability_part(part_file(out, kStabilityName, whole.shard), whole);
  write_stability(out, whole);
  return whole;
}

std::size_t inputs_of(const StabilityPart& part) {
  std::size_t inputs = 0;
  for (const StabilityColumn& column : part.columns) inputs += column.inputs;
  return inputs;
}

}  // namespace gnomon::apps::study
