#include "ar/ply_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/text_words.h"

namespace gnomon::ar {

namespace fs = std::filesystem;

namespace {

/// A type's bytes, and whether it can be a list's count.
struct Type {
  std::uint64_t size = 0;
  bool whole = false, is_signed = false;
};

/// A value, or a list of them after its count.
struct Property {
  bool list = false;
  Type count, value;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

class PlyWalk {
 public:
  PlyWalk(std::span<const std::uint8_t> bytes, const fs::path& path)
      : path_(path), text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

  void run() {
    read_header();
    for (const Element& element : elements_) {
      if (element.properties.empty() && element.count > 0)
        fail(fmt::format("element {} has no property", element.name));
      for (std::uint64_t i = 0; i < element.count; ++i)
        format_ == "ascii" ? walk_line(element, i) : walk_bytes(element, i);
    }
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(fmt::format("{}: PLY: {}", one_line(path_.string()), one_line(what)));
  }

  std::string_view next_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    return line;
  }

  std::uint64_t count_of(std::string_view word, std::string_view where) const {
    const std::optional<std::uint64_t> count = parse_count(word);
    if (!count) fail(fmt::format("{}: '{}' is no count", where, word.substr(0, 40)));
    return *count;
  }

  Type type_of(std::string_view word, std::string_view line) const {
    static const std::map<std::string, Type, std::less<>> kTypes{
        {"char", {1, true, true}},  {"uchar", {1, true}},       {"int8", {1, true, true}},
        {"uint8", {1, true}},       {"short", {2, true, true}}, {"ushort", {2, true}},
        {"int16", {2, true, true}}, {"uint16", {2, true}},      {"int", {4, true, true}},
        {"uint", {4, true}},        {"int32", {4, true, true}}, {"uint32", {4, true}},
        {"float", {4, false}},      {"float32", {4, false}},    {"double", {8, false}},
        {"float64", {8, false}}};
    const auto known = kTypes.find(word);
    if (known == kTypes.end()) fail(fmt::format("\"{}\": unknown type", line.substr(0, 60)));
    return known->second;
  }

  void read_header() {
    while (true) {
      if (at_ >= text_.size()) fail("the header has no end_header");
      const std::string_view whole = next_line();
      std::string_view line = whole;
      const std::string_view keyword = next_word(line);
      if (keyword == "end_header") break;
      if (keyword == "format") format_ = next_word(line);
      if (keyword == "element") {
        Element element{.name = std::string(next_word(line).substr(0, 40))};
        element.count = count_of(next_word(line), fmt::format("element {}", element.name));
        elements_.push_back(std::move(element));
      }
      if (keyword == "property") {
        if (elements_.empty()) fail("a property before any element");
        Property property;
        std::string_view type = next_word(line);
        if (type == "list") {
          property.list = true;
          property.count = type_of(next_word(line), whole);
          if (!property.count.whole)
            fail(fmt::format("\"{}\": a list's count is a whole number", whole.substr(0, 60)));
          type = next_word(line);
        }
        property.value = type_of(type, whole);
        elements_.back().properties.push_back(property);
      }
    }
    if (format_ != "ascii" && format_ != "binary_little_endian" && format_ != "binary_big_endian")
      fail(fmt::format("format '{}' is not read", format_.substr(0, 40)));
  }

  void require_number(std::string_view word, const Element& element, std::uint64_t index) const {
    if (!is_number(word))
      fail(fmt::format("{} {}: '{}' is no number", element.name, index, word.substr(0, 40)));
  }

  void walk_line(const Element& element, std::uint64_t index) {
    if (at_ >= text_.size())
      fail(fmt::format("{} of element {} are announced, {} are there", element.count, element.name,
                       index));
    std::string_view line = next_line();
    for (const Property& property : element.properties) {
      std::uint64_t values = 1;
      if (property.list)
        values = count_of(next_word(line), fmt::format("{} {}", element.name, index));
      for (std::uint64_t i = 0; i < values; ++i) require_number(next_word(line), element, index);
    }
  }

  void walk_bytes(const Element& element, std::uint64_t index) {
    const auto take = [&](std::uint64_t size) {
      if (size > text_.size() - at_)
        fail(fmt::format("{} of element {} are announced, {} are there", element.count,
                         element.name, index));
      const std::string_view taken = text_.substr(at_, size);
      at_ += size;
      return taken;
    };
    for (const Property& property : element.properties) {
      std::uint64_t values = 1;
      if (property.list) {
        values = 0;
        const std::string_view count = take(property.count.size);
        for (std::size_t i = 0; i < count.size(); ++i) {
          const std::size_t from = format_ == "binary_big_endian" ? i : count.size() - 1 - i;
          values = values << 8 | static_cast<unsigned char>(count[from]);
        }
        if (property.count.is_signed && values >> (8 * property.count.size - 1) != 0)
          fail(fmt::format("{} {}: a list's count is negative", element.name, index));
      }
      take(values * property.value.size);
    }
  }

  const fs::path& path_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::string format_;
  std::vector<Element> elements_;
};

}  // namespace

void check_ply_bytes(std::span<const std::uint8_t> bytes, const fs::path& path) {
  PlyWalk(bytes, path).run();
}

}  // namespace gnomon::ar
