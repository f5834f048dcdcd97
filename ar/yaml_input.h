// Reading YAML (and JSON, which is YAML's flow form) that others wrote. Every helper throws
// InputError with the file, the line, the key and the value. Internal to ar/: shows yaml-cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "ar/error.h"

namespace gnomon::ar::yaml {

/// Larger files are refused before they are read.
inline constexpr std::size_t kMaxFileBytes = std::size_t{4} << 20;

/// "file:line: place: what" as an InputError; `node` gives the line if it has one.
[[noreturn]] void fail(const std::filesystem::path& file, const YAML::Node& node,
                       const std::string& place, const std::string& what);

/// The file's document, a map. OpenCV's "%YAML:1.0" head is accepted.
YAML::Node load(const std::filesystem::path& file);

/// A finite number.
double number(const std::filesystem::path& file, const YAML::Node& node, const std::string& place);

/// An integer in [low, high].
int integer(const std::filesystem::path& file, const YAML::Node& node, const std::string& place,
            int low, int high);

/// A sequence of at most `max_count` finite numbers.
std::vector<double> numbers(const std::filesystem::path& file, const YAML::Node& node,
                            const std::string& place, std::size_t max_count);

/// A scalar of at most `max_length` bytes.
std::string text(const std::filesystem::path& file, const YAML::Node& node,
                 const std::string& place, std::size_t max_length);

}  // namespace gnomon::ar::yaml
