// A TOML table that is read strictly: every key is known beforehand, every value has a type and a
// range, and every complaint names file, line, table, key and value. Internal to ar/: shows toml++.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace gnomon::ar {

inline constexpr double kAnyNumber = std::numeric_limits<double>::max();

/// Throws InputError "FILE:LINE: what".
[[noreturn]] void fail_at(const std::filesystem::path& file, const toml::node& node,
                          std::string_view what);

/// The file's document, whose key `format` must have this value. Throws InputError "FILE:LINE: ..."
/// also for a file over `max_bytes`.
toml::table load_toml(const std::filesystem::path& file, std::uint64_t max_bytes,
                      std::string_view format);

class TomlTable {
 public:
  /// `place` is how messages call the table. Throws InputError for a key that is not `known`.
  TomlTable(const std::filesystem::path& file, const toml::table& table, std::string place,
            std::initializer_list<std::string_view> known);

  bool has(std::string_view key) const { return table_.contains(key); }

  /// Absent when the key is; InputError when the value has another type or is out of range.
  std::optional<double> number(std::string_view key, double low = -kAnyNumber,
                               double high = kAnyNumber) const;
  std::optional<int> integer(std::string_view key, int low, int high) const;
  std::optional<bool> boolean(std::string_view key) const;
  /// Not empty, without control characters, at most 4096 bytes.
  std::optional<std::string> text(std::string_view key) const;
  std::optional<glm::dvec3> vector(std::string_view key, double low = -kAnyNumber,
                                   double high = kAnyNumber) const;
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count) const;
  /// Four rows of four numbers, the last one 0 0 0 1.
  std::optional<glm::dmat4> matrix(std::string_view key) const;
  std::optional<std::vector<std::string>> texts(std::string_view key) const;
  /// A file that exists, joined to the scene file's folder.
  std::optional<std::filesystem::path> file(std::string_view key) const;

  /// The sub-table, or the elements of an array of tables (none if absent).
  const toml::table* table(std::string_view key) const;
  std::vector<const toml::table*> tables(std::string_view key) const;

  /// Throws InputError about the key, or about the table where the key is absent.
  [[noreturn]] void fail(std::string_view key, std::string_view what) const;
  /// The value, or an InputError that the key is missing.
  template <class T>
  T required(std::string_view key, std::optional<T> value) const {
    if (!value) fail(key, "missing");
    return *std::move(value);
  }

  const std::filesystem::path& path() const { return file_; }
  const std::string& place() const { return place_; }

 private:
  double number_in(const toml::node& node, std::string_view key, double low, double high) const;
  [[noreturn]] void fail_value(const toml::node& node, std::string_view key,
                               std::string_view what) const;

  const std::filesystem::path& file_;
  const toml::table& table_;
  std::string place_;
};

/// A value as it stands in the file, shortened, for messages.
std::string shown(const toml::node& node);

}  // namespace gnomon::ar
