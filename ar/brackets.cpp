#include "ar/brackets.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/image_file.h"
#include "ar/yaml_input.h"

namespace gnomon::ar {
namespace {

constexpr std::size_t kMostExposures = 64;
constexpr double kLongestTimeS = 1e6;
/// How much darker, in pixel values, noise may make the mean of a longer exposure.
constexpr double kDarkerByNoise = 1.0;

double read_time(const std::filesystem::path& list, const YAML::Node& node,
                 const std::string& place) {
  const double time_s = yaml::number(list, node, place);
  if (!(time_s > 0.0 && time_s <= kLongestTimeS))
    yaml::fail(list, node, place, fmt::format("{:g} is no exposure time in seconds", time_s));
  return time_s;
}

void read_list(Brackets& brackets) {
  const std::filesystem::path& list = brackets.list;
  const YAML::Node root = yaml::load(list), entries = root["exposures"];
  if (!entries.IsDefined() || !entries.IsSequence())
    yaml::fail(list, entries, "exposures", "expected a list of {file, time_s}");
  if (entries.size() < 2 || entries.size() > kMostExposures)
    yaml::fail(list, entries, "exposures",
               fmt::format("{} exposures are not 2 to {}", entries.size(), kMostExposures));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string place = fmt::format("exposures[{}]", i);
    if (!entries[i].IsMap()) yaml::fail(list, entries[i], place, "expected {file, time_s}");
    Exposure exposure;
    exposure.file =
        list.parent_path() / yaml::text(list, entries[i]["file"], place + ".file", 4096);
    exposure.time_s = read_time(list, entries[i]["time_s"], place + ".time_s");
    brackets.exposures.push_back(std::move(exposure));
  }
  if (root["auto_exposure_time_s"].IsDefined())
    brackets.photograph_time_s =
        read_time(list, root["auto_exposure_time_s"], "auto_exposure_time_s");
  std::stable_sort(brackets.exposures.begin(), brackets.exposures.end(),
                   [](const Exposure& a, const Exposure& b) { return a.time_s < b.time_s; });
  const double shortest = brackets.exposures.front().time_s;
  if (!(brackets.exposures.back().time_s > shortest))
    yaml::fail(list, entries, "exposures",
               fmt::format("all {} take {:g} s: nothing to tell the response from", entries.size(),
                           shortest));
}

double mean_value(const Image& picture) {
  std::uint64_t sum = 0;
  for (const std::uint8_t value : picture.pixels) sum += value;
  return static_cast<double>(sum) / static_cast<double>(picture.pixels.size());
}

void check_light(const Brackets& brackets) {
  const auto all = [&](auto bad) {
    return std::all_of(brackets.exposures.begin(), brackets.exposures.end(),
                       [&](const Exposure& e) {
                         return std::all_of(e.picture.pixels.begin(), e.picture.pixels.end(), bad);
                       });
  };
  const std::string list = brackets.list.string();
  if (all([](std::uint8_t v) { return v == 0; }))
    throw InputError(fmt::format("{}: every exposure is black: longer times are needed", list));
  if (all([](std::uint8_t v) { return v == 255; }))
    throw InputError(
        fmt::format("{}: every exposure is saturated: shorter times are needed", list));
  double brightest = 0.0;
  for (const Exposure& e : brackets.exposures) {
    const double mean = mean_value(e.picture);
    if (mean < brightest - kDarkerByNoise)
      throw InputError(
          fmt::format("{}: {:g} s, but darker (mean value {:.1f}) than a shorter exposure ({:.1f})",
                      e.file.string(), e.time_s, mean, brightest));
    brightest = std::max(brightest, mean);
  }
}

}  // namespace

Brackets read_brackets(const std::filesystem::path& list) {
  Brackets brackets;
  brackets.list = list;
  read_list(brackets);
  for (Exposure& e : brackets.exposures) {
    e.picture = read_image_rgb(e.file);
    if (e.picture.width != brackets.width() || e.picture.height != brackets.height())
      throw InputError(fmt::format("{}: {} x {} pixels, but {} has {} x {}", e.file.string(),
                                   e.picture.width, e.picture.height,
                                   brackets.exposures.front().file.string(), brackets.width(),
                                   brackets.height()));
  }
  check_light(brackets);
  return brackets;
}

}  // namespace gnomon::ar
