#include "ar/yaml_input.h"

#include <cmath>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

namespace gnomon::ar::yaml {
namespace {

constexpr std::size_t kShownValueBytes = 40;

/// A value for an error's one line: short, and without control characters.
std::string shown(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "nothing";
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return fmt::format("a list of {}", node.size());
  std::string value = node.Scalar().substr(0, kShownValueBytes);
  for (char& c : value) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return "'" + value + "'";
}

std::string one_line(std::string message) {
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return message;
}

std::string read_bounded(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw InputError(fmt::format("{}: is a folder, not a file", file.string()));
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be opened", file.string()));
  std::string bytes(kMaxFileBytes + 1, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) throw InputError(fmt::format("{}: cannot be read", file.string()));
  if (bytes.size() > kMaxFileBytes) {
    throw InputError(
        fmt::format("{}: is larger than the {} bytes that are read", file.string(), kMaxFileBytes));
  }
  return bytes;
}

/// OpenCV writes its directive with a colon, which YAML's grammar does not have.
void normalise_directive(std::string& bytes) {
  constexpr std::string_view kOpenCv = "%YAML:";
  const std::size_t at = bytes.starts_with("\xef\xbb\xbf") ? 3 : 0;
  if (bytes.compare(at, kOpenCv.size(), kOpenCv) != 0) return;
  std::size_t end = bytes.find('\n', at);
  if (end == std::string::npos) end = bytes.size();
  for (std::size_t i = at; i < end; ++i) bytes[i] = i == at ? '#' : ' ';
}

}  // namespace

void fail(const std::filesystem::path& file, const YAML::Node& node, const std::string& place,
          const std::string& what) {
  std::string head = file.string();
  if (node.IsDefined() && node.Mark().line >= 0) head += fmt::format(":{}", node.Mark().line + 1);
  throw InputError(one_line(fmt::format("{}: {}: {}", head, place, what)));
}

YAML::Node load(const std::filesystem::path& file) {
  std::string bytes = read_bounded(file);
  normalise_directive(bytes);
  YAML::Node root;
  try {
    root = YAML::Load(bytes);
  } catch (const YAML::Exception& e) {
    throw InputError(
        one_line(fmt::format("{}:{}: not YAML: {}", file.string(), e.mark.line + 1, e.msg)));
  }
  if (!root.IsMap()) {
    throw InputError(fmt::format("{}: top level: expected keys and values, found {}", file.string(),
                                 shown(root)));
  }
  return root;
}

double number(const std::filesystem::path& file, const YAML::Node& node, const std::string& place) {
  double value = 0.0;
  if (!node.IsDefined() || !node.IsScalar() || !YAML::convert<double>::decode(node, value)) {
    fail(file, node, place, "expected a number, found " + shown(node));
  }
  if (!std::isfinite(value)) {
    fail(file, node, place, "expected a finite number, found " + shown(node));
  }
  return value;
}

int integer(const std::filesystem::path& file, const YAML::Node& node, const std::string& place,
            int low, int high) {
  const double value = number(file, node, place);
  if (value != std::floor(value) || value < low || value > high) {
    fail(file, node, place,
         fmt::format("expected an integer from {} to {}, found {}", low, high, shown(node)));
  }
  return static_cast<int>(value);
}

std::vector<double> numbers(const std::filesystem::path& file, const YAML::Node& node,
                            const std::string& place, std::size_t max_count) {
  if (!node.IsDefined() || !node.IsSequence()) {
    fail(file, node, place, "expected a list of numbers, found " + shown(node));
  }
  if (node.size() > max_count) {
    fail(file, node, place,
         fmt::format("expected at most {} numbers, found {}", max_count, shown(node)));
  }
  std::vector<double> values;
  values.reserve(node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    values.push_back(number(file, node[i], fmt::format("{}[{}]", place, i)));
  }
  return values;
}

std::string text(const std::filesystem::path& file, const YAML::Node& node,
                 const std::string& place, std::size_t max_length) {
  if (!node.IsDefined() || !node.IsScalar()) {
    fail(file, node, place, "expected text, found " + shown(node));
  }
  if (node.Scalar().size() > max_length) {
    fail(file, node, place, fmt::format("text is longer than {} bytes", max_length));
  }
  return node.Scalar();
}

}  // namespace gnomon::ar::yaml
