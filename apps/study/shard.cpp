#include "apps/study/shard.h"

#include <charconv>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/file.h"

namespace gnomon::apps::study {

Shard parse_shard(const std::string& option, const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  bool read = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  if (read) {
    const auto count = std::from_chars(number.ptr + 1, end, shard.count);
    read = count.ec == std::errc() && count.ptr == end;
  }
  if (!read || shard.number < 1 || shard.number > shard.count || shard.count > kMostShards)
    throw ar::InputError(fmt::format("{}: '{}' is not I/N with I from 1 to N and N up to {}",
                                     option, ar::one_line(text), kMostShards));
  return shard;
}

}  // namespace gnomon::apps::study
