#include "ar/toml_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ar/error.h"
#include "ar/file.h"

namespace gnomon::ar {

namespace fs = std::filesystem;

void fail_at(const fs::path& file, const toml::node& node, std::string_view what) {
  throw InputError(
      fmt::format("{}:{}: {}", one_line(file.string()), node.source().begin.line, one_line(what)));
}

std::string shown(const toml::node& node) {
  std::ostringstream text;
  if (node.is_table() || node.is_array_of_tables()) return "a table";
  node.visit([&text](const auto& value) { text << value; });
  std::string line = one_line(text.str());
  if (line.size() > 80) line = line.substr(0, 77) + "...";
  return line;
}

toml::table load_toml(const fs::path& file, std::uint64_t max_bytes, std::string_view format) {
  const std::vector<std::uint8_t> bytes = read_file(file, max_bytes);
  toml::table root;
  try {
    root = toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  } catch (const toml::parse_error& e) {
    throw InputError(fmt::format("{}:{}: {}", one_line(file.string()), e.source().begin.line,
                                 one_line(e.description())));
  }
  // Before the keys: another format has other keys.
  const toml::node* node = root.get("format");
  if (node == nullptr)
    fail_at(file, root, fmt::format("format: missing (accepted: \"{}\")", format));
  if (node->value<std::string>() != std::string(format))
    fail_at(file, *node,
            fmt::format("format: {} is not read (accepted: \"{}\")", shown(*node), format));
  return root;
}

TomlTable::TomlTable(const fs::path& file, const toml::table& table, std::string place,
                     std::initializer_list<std::string_view> known)
    : file_(file), table_(table), place_(std::move(place)) {
  for (const auto& [key, value] : table)
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      fail_value(value, key.str(), fmt::format("unknown key (known: {})", fmt::join(known, ", ")));
}

void TomlTable::fail_value(const toml::node& node, std::string_view key,
                           std::string_view what) const {
  fail_at(file_, node, fmt::format("{}{}{}: {}", place_, place_.empty() ? "" : ".", key, what));
}

void TomlTable::fail(std::string_view key, std::string_view what) const {
  const toml::node* node = table_.get(key);
  fail_value(node != nullptr ? *node : static_cast<const toml::node&>(table_), key, what);
}

double TomlTable::number_in(const toml::node& node, std::string_view key, double low,
                            double high) const {
  const std::optional<double> value =
      node.is_number() ? node.value<double>() : std::optional<double>();
  if (!value) fail_value(node, key, fmt::format("{} is not a number", shown(node)));
  if (!std::isfinite(*value)) fail_value(node, key, fmt::format("{} is not finite", *value));
  if (*value < low || *value > high)
    fail_value(node, key,
               high == kAnyNumber ? fmt::format("{} is below {}", *value, low)
                                  : fmt::format("{} is not within {} to {}", *value, low, high));
  return *value;
}

std::optional<double> TomlTable::number(std::string_view key, double low, double high) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return std::nullopt;
  return number_in(*node, key, low, high);
}

std::optional<int> TomlTable::integer(std::string_view key, int low, int high) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_integer())
    fail_value(*node, key, fmt::format("{} is not an integer", shown(*node)));
  return static_cast<int>(number_in(*node, key, low, high));
}

std::optional<bool> TomlTable::boolean(std::string_view key) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean())
    fail_value(*node, key, fmt::format("{} is not true or false", shown(*node)));
  return node->value<bool>();
}

namespace {

/// What is wrong with a text, or nothing.
std::optional<std::string> text_fault(const toml::node& node) {
  const std::optional<std::string> text =
      node.is_string() ? node.value<std::string>() : std::optional<std::string>();
  if (!text) return fmt::format("{} is not a text in quotes", shown(node));
  if (text->empty()) return "is empty";
  if (text->size() > 4096) return fmt::format("a text of {} bytes", text->size());
  if (std::any_of(text->begin(), text->end(),
                  [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
    return fmt::format("{} has a control character", shown(node));
  return std::nullopt;
}

}  // namespace

std::optional<std::string> TomlTable::text(std::string_view key) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return std::nullopt;
  if (const auto fault = text_fault(*node)) fail_value(*node, key, *fault);
  return node->value<std::string>();
}

std::optional<std::vector<std::string>> TomlTable::texts(std::string_view key) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array == nullptr) fail_value(*node, key, fmt::format("{} is not a list", shown(*node)));
  std::vector<std::string> texts;
  for (const toml::node& element : *array) {
    if (const auto fault = text_fault(element)) fail_value(element, key, *fault);
    texts.push_back(*element.value<std::string>());
  }
  return texts;
}

std::optional<std::vector<double>> TomlTable::numbers(std::string_view key,
                                                      std::size_t count) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != count)
    fail_value(*node, key, fmt::format("{} is not a list of {} numbers", shown(*node), count));
  std::vector<double> values;
  for (const toml::node& element : *array)
    values.push_back(number_in(element, key, -kAnyNumber, kAnyNumber));
  return values;
}

std::optional<glm::dvec3> TomlTable::vector(std::string_view key, double low, double high) const {
  const auto values = numbers(key, 3);
  if (!values) return std::nullopt;
  for (const toml::node& element : *table_.get(key)->as_array()) number_in(element, key, low, high);
  return glm::dvec3((*values)[0], (*values)[1], (*values)[2]);
}

std::optional<glm::dmat4> TomlTable::matrix(std::string_view key) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* rows = node->as_array();
  if (rows == nullptr || rows->size() != 4)
    fail_value(*node, key, fmt::format("{} is not a list of 4 rows", shown(*node)));
  glm::dmat4 m(1.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const toml::array* row = (*rows)[r].as_array();
    if (row == nullptr || row->size() != 4)
      fail_value((*rows)[r], key,
                 fmt::format("row {}: {} is not a list of 4 numbers", r, shown((*rows)[r])));
    for (std::size_t c = 0; c < 4; ++c)
      m[static_cast<int>(c)][static_cast<int>(r)] =
          number_in((*row)[c], fmt::format("{}[{}][{}]", key, r, c), -kAnyNumber, kAnyNumber);
  }
  if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0)
    fail_value((*rows)[3], key, fmt::format("last row {} is not [0, 0, 0, 1]", shown((*rows)[3])));
  return m;
}

std::optional<fs::path> TomlTable::file(std::string_view key) const {
  const std::optional<std::string> name = text(key);
  if (!name) return std::nullopt;
  const fs::path path = file_.parent_path() / *name;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) fail(key, fmt::format("no such file: {}", path.string()));
  return path;
}

const toml::table* TomlTable::table(std::string_view key) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) fail_value(*node, key, fmt::format("{} is not a table", shown(*node)));
  return node->as_table();
}

std::vector<const toml::table*> TomlTable::tables(std::string_view key) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  if (array == nullptr)
    fail_value(*node, key,
               fmt::format("{} is not a list of tables: write [[{}]]", shown(*node), key));
  std::vector<const toml::table*> tables;
  for (const toml::node& element : *array) {
    if (!element.is_table())
      fail_value(element, key, fmt::format("{} is not a table", shown(element)));
    tables.push_back(element.as_table());
  }
  return tables;
}

}  // namespace gnomon::ar
