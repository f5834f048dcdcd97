// The files that the parts of a run leave in its folder, and what all of them hold.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/study/shard.h"

namespace gnomon::apps::study {

/// FOLDER/NAME.json of a whole run, FOLDER/NAME-2-of-8.json of a part.
std::filesystem::path part_file(const std::filesystem::path& folder, std::string_view name,
                                const Shard& shard);

/// Where a part that begins now is to be written when it is done. Takes away what an earlier run
/// left there, which speaks of other results.
std::filesystem::path begin_part(const std::filesystem::path& folder, std::string_view name,
                                 const Shard& shard);

/// The parts of a run that lie in the folder, in order, without a whole run's file. Throws
/// ar::InputError when there is none, one is missing, or parts of differently many lie there.
std::vector<std::filesystem::path> find_parts(const std::filesystem::path& folder,
                                              std::string_view name);

/// Hands the document to `read` if its "format" is this. Throws ar::InputError in one line that
/// names the file, also of what nlohmann::json throws meanwhile.
void read_part(const std::filesystem::path& file, std::string_view format,
               const std::function<void(const nlohmann::json&)>& read);

/// Writes beside, then renames; an object or array a line. Throws ar::InputError.
void write_part(const std::filesystem::path& file, const nlohmann::ordered_json& document);

/// What files say, checked. Throws ar::InputError: no whole number from 0 to `most`.
std::size_t count_in(const nlohmann::json& value, std::size_t most);
/// [number, count].
Shard shard_in(const nlohmann::json& value);
/// The numbers of jobs of this shard.
std::vector<std::size_t> jobs_in(const nlohmann::json& value, std::size_t jobs, const Shard& shard);

/// Jobs that a run may have.
inline constexpr std::size_t kMostJobs = 100'000'000;

/// Are these all the numbers from 0 on, `jobs` of them? Throws ar::InputError if not.
/// Precondition: ascending.
void require_every_job(std::size_t jobs, std::span<const std::size_t> done);

/// Is the name a file in its folder and nothing else: letters, digits, '-', '_' and '.'?
bool is_plain_name(std::string_view name);

/// The text's first 150 bytes with everything that is_plain_name refuses replaced by '_'.
std::string plain_name(std::string_view text);

}  // namespace gnomon::apps::study
