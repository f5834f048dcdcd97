#include "apps/study/part_file.h"

#include <algorithm>
#include <map>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/file.h"

namespace gnomon::apps::study {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uint64_t kMaxPartBytes = std::uint64_t{256} << 20;

/// Of "NAME-2-of-8.json".
std::optional<Shard> shard_of(const std::string& file_name, std::string_view name) {
  constexpr std::string_view kBetween = "-of-", kEnd = ".json";
  const std::string start = std::string(name) + "-";
  if (!file_name.starts_with(start) || !file_name.ends_with(kEnd)) return std::nullopt;
  std::string middle = file_name.substr(start.size());
  middle.resize(middle.size() - kEnd.size());
  const std::size_t at = middle.find(kBetween);
  if (at == std::string::npos) return std::nullopt;
  try {
    return parse_shard(file_name, middle.replace(at, kBetween.size(), "/"));
  } catch (const ar::InputError&) {
    return std::nullopt;
  }
}

}  // namespace

fs::path part_file(const fs::path& folder, std::string_view name, const Shard& shard) {
  if (shard.is_whole()) return folder / fmt::format("{}.json", name);
  return folder / fmt::format("{}-{}-of-{}.json", name, shard.number, shard.count);
}

fs::path begin_part(const fs::path& folder, std::string_view name, const Shard& shard) {
  fs::path file = part_file(folder, name, shard);
  std::error_code ignored;
  fs::remove(file, ignored);
  return file;
}

std::vector<fs::path> find_parts(const fs::path& folder, std::string_view name) {
  std::map<std::size_t, fs::path> found;
  std::optional<std::size_t> count;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path file = entry->path().filename();
    const auto shard = shard_of(file.string(), name);
    if (!shard || file != part_file({}, name, *shard)) continue;
    if (count.value_or(shard->count) != shard->count)
      throw ar::InputError(fmt::format("{}: parts of {} and of {} lie there; take away the others",
                                       ar::one_line(folder.string()), *count, shard->count));
    count = shard->count;
    found[shard->number] = entry->path();
  }
  if (error) throw ar::InputError(ar::one_line(folder.string()) + ": cannot be read");
  if (!count)
    throw ar::InputError(
        fmt::format("{}: no {}-I-of-N.json lies there", ar::one_line(folder.string()), name));
  std::vector<fs::path> parts;
  for (std::size_t number = 1; number <= *count; ++number) {
    const auto part = found.find(number);
    if (part == found.end())
      throw ar::InputError(fmt::format("{}: part {} of {} is missing",
                                       ar::one_line(folder.string()), number, *count));
    parts.push_back(part->second);
  }
  return parts;
}

void read_part(const fs::path& file, std::string_view format,
               const std::function<void(const json&)>& read) {
  const std::string name = ar::one_line(file.string());
  const std::vector<std::uint8_t> bytes = ar::read_file(file, kMaxPartBytes);
  try {
    const json document = json::parse(bytes);
    const std::string found = document.at("format").get<std::string>();
    if (found != format)
      throw ar::InputError(fmt::format("{}: format '{}' is not \"{}\"", name,
                                       ar::one_line(found.substr(0, 80)), format));
    read(document);
  } catch (const json::exception& wrong) {
    throw ar::InputError(fmt::format("{}: {}", name, ar::one_line(wrong.what())));
  } catch (const ar::InputError& wrong) {
    const std::string what = wrong.what();
    if (what.starts_with(name)) throw;
    throw ar::InputError(fmt::format("{}: {}", name, what));
  }
}

void write_part(const fs::path& file, const nlohmann::ordered_json& document) {
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  ar::write_file(file, document.dump(1, ' ', false, kReplace) + "\n");
}

std::size_t count_in(const json& value, std::size_t most) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most)
    throw ar::InputError(
        fmt::format("{} is no count up to {}", ar::one_line(value.dump().substr(0, 80)), most));
  return value.get<std::size_t>();
}

Shard shard_in(const json& value) {
  Shard shard{count_in(value.at(0), kMostShards), count_in(value.at(1), kMostShards)};
  if (shard.number < 1 || shard.number > shard.count)
    throw ar::InputError("shard: there is no such part");
  return shard;
}

std::vector<std::size_t> jobs_in(const json& value, std::size_t jobs, const Shard& shard) {
  std::vector<std::size_t> done;
  for (const json& job : value) {
    done.push_back(count_in(job, jobs));
    if (!shard.has(done.back()))
      throw ar::InputError(fmt::format("job {} is of another part", done.back()));
  }
  return done;
}

void require_every_job(std::size_t jobs, std::span<const std::size_t> done) {
  for (std::size_t i = 0; i < done.size(); ++i) {
    if (done[i] >= jobs) throw ar::InputError(fmt::format("there is no job {}", done[i]));
    if (done[i] < i) throw ar::InputError(fmt::format("job {} is there twice", done[i]));
    if (done[i] > i) throw ar::InputError(fmt::format("job {} is missing", i));
  }
  if (done.size() != jobs) throw ar::InputError(fmt::format("job {} is missing", done.size()));
}

bool is_plain_name(std::string_view name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  };
  return !name.empty() && name.front() != '.' && name.size() <= 200 &&
         std::ranges::all_of(name, plain);
}

std::string plain_name(std::string_view text) {
  std::string out(text.substr(0, 150));
  for (char& c : out)
    if (!is_plain_name(std::string_view(&c, 1)) && c != '.') c = '_';
  if (out.empty() || out.front() == '.') out.insert(out.begin(), '_');
  return out;
}

}  // namespace gnomon::apps::study
