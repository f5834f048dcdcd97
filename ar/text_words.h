// The words of a text file, and what numbers they are.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace gnomon::ar {

/// Takes the next word off a text; empty at its end.
std::string_view next_word(std::string_view& text);

/// The word as a whole number from 0 on; nothing if it is none.
std::optional<std::uint64_t> parse_count(std::string_view word);

/// The word is a number, also one that no double holds.
bool is_number(std::string_view word);

}  // namespace gnomon::ar
