#include "apps/study/stability_part.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/study/csv.h"
#include "apps/study/part_file.h"
#include "ar/error.h"

namespace gnomon::apps::study {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

ordered_json to_json(const SweepText& text, const std::vector<std::string>& methods) {
  return {
      {"name", text.name},           {"title", text.title},     {"explanation", text.explanation},
      {"parameter", text.parameter}, {"measure", text.measure}, {"oracle", text.oracle},
      {"methods", methods}};
}

SweepText text_of(const json& in) {
  return {in.at("name").get<std::string>(),        in.at("title").get<std::string>(),
          in.at("explanation").get<std::string>(), in.at("parameter").get<std::string>(),
          in.at("measure").get<std::string>(),     in.at("oracle").get<std::string>()};
}

ordered_json to_json(const StabilityColumn& column) {
  ordered_json outcomes = ordered_json::array();
  for (std::size_t i = 0; i < column.outcomes.size(); ++i) {
    const Outcome& o = column.outcomes[i];
    outcomes.push_back({o.wrong, o.of, o.not_finite, column.worst[i]});
  }
  return {{"job", column.job},
          {"sweep", column.sweep},
          {"value", column.value},
          {"inputs", column.inputs},
          {"outcomes", outcomes}};
}

double amount(const json& value) {
  const double number = value.get<double>();
  if (!std::isfinite(number) || number < 0.0)
    throw ar::InputError(fmt::format("{} is no number of pixels or frames", value.dump()));
  return number;
}

StabilityColumn column_of(const json& in, const StabilityPart& part) {
  StabilityColumn column{.job = count_in(in.at("job"), kMostJobs),
                         .sweep = count_in(in.at("sweep"), kMostJobs),
                         .value = in.at("value").get<std::string>(),
                         .inputs = count_in(in.at("inputs"), kMostJobs)};
  if (!part.shard.has(column.job))
    throw ar::InputError(fmt::format("job {} is of another part", column.job));
  if (column.sweep >= part.sweeps.size())
    throw ar::InputError(fmt::format("there is no sweep {}", column.sweep));
  for (const json& outcome : in.at("outcomes")) {
    column.outcomes.push_back({amount(outcome.at(0)), amount(outcome.at(1)),
                               count_in(outcome.at(2), std::numeric_limits<std::uint32_t>::max())});
    column.worst.push_back(amount(outcome.at(3)));
  }
  if (column.outcomes.size() != part.methods[column.sweep].size())
    throw ar::InputError(fmt::format("job {}: not one outcome a method", column.job));
  return column;
}

}  // namespace

void write_stability_part(const std::filesystem::path& file, const StabilityPart& part) {
  ordered_json sweeps = ordered_json::array(), columns = ordered_json::array();
  for (std::size_t i = 0; i < part.sweeps.size(); ++i)
    sweeps.push_back(to_json(part.sweeps[i], part.methods[i]));
  for (const StabilityColumn& column : part.columns) columns.push_back(to_json(column));
  write_part(file, {{"format", kStabilityFormat},
                    {"shard", {part.shard.number, part.shard.count}},
                    {"jobs", part.jobs},
                    {"sweeps", sweeps},
                    {"columns", columns}});
}

StabilityPart read_stability_part(const std::filesystem::path& file) {
  StabilityPart part;
  read_part(file, kStabilityFormat, [&](const json& document) {
    part.shard = shard_in(document.at("shard"));
    part.jobs = count_in(document.at("jobs"), kMostJobs);
    for (const json& sweep : document.at("sweeps")) {
      part.sweeps.push_back(text_of(sweep));
      part.methods.push_back(sweep.at("methods").get<std::vector<std::string>>());
    }
    for (const json& column : document.at("columns"))
      part.columns.push_back(column_of(column, part));
  });
  return part;
}

StabilityPart merge_stability_parts(std::span<const StabilityPart> parts) {
  StabilityPart whole;
  if (!parts.empty()) {
    whole.jobs = parts.front().jobs;
    whole.sweeps = parts.front().sweeps;
    whole.methods = parts.front().methods;
  }
  for (const StabilityPart& part : parts) {
    if (part.jobs != whole.jobs || part.sweeps != whole.sweeps || part.methods != whole.methods)
      throw ar::InputError("parts of different runs do not belong together");
    whole.columns.insert(whole.columns.end(), part.columns.begin(), part.columns.end());
  }
  std::ranges::sort(whole.columns, {}, &StabilityColumn::job);
  std::vector<std::size_t> done;
  for (const StabilityColumn& column : whole.columns) done.push_back(column.job);
  require_every_job(whole.jobs, done);
  return whole;
}

std::string stability_csv(const StabilityPart& part) {
  std::string out =
      "sweep,parameter,value,method,measure,wrong,of,share,worst_share,inputs,not_finite\n";
  for (const StabilityColumn& column : part.columns) {
    const SweepText& text = part.sweeps[column.sweep];
    for (std::size_t i = 0; i < column.outcomes.size(); ++i) {
      const Outcome& o = column.outcomes[i];
      out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", csv_quoted(text.name),
                         csv_quoted(text.parameter), csv_quoted(column.value),
                         csv_quoted(part.methods[column.sweep][i]), csv_quoted(text.measure),
                         o.wrong, o.of, o.share(), column.worst[i], column.inputs, o.not_finite);
    }
  }
  return out;
}

std::vector<const StabilityColumn*> columns_of(const StabilityPart& part, std::size_t sweep) {
  std::vector<const StabilityColumn*> columns;
  for (const StabilityColumn& column : part.columns)
    if (column.sweep == sweep) columns.push_back(&column);
  return columns;
}

std::size_t border_of(const std::vector<const StabilityColumn*>& columns, std::size_t method) {
  std::size_t border = columns.size();
  while (border > 0 && columns[border - 1]->outcomes[method].share() >= kGivenUp) --border;
  return border;
}

}  // namespace gnomon::apps::study
