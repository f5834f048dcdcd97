// Pictures inside a page.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ar/image.h"

namespace gnomon::apps::study {

/// Reads pictures of a folder, each once, and makes them small.
class PageImages {
 public:
  static constexpr int kWidth = 320;

  explicit PageImages(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Its place among data_uris. Throws ar::InputError when it cannot be read.
  std::size_t add(const std::string& name);
  /// JPEG, base64, at most kWidth pixels wide.
  const std::vector<std::string>& data_uris() const { return uris_; }

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::size_t> known_;
  std::vector<std::string> uris_;
};

/// The picture made smaller by a whole number, so that it is at most that wide: means of squares of
/// pixels; what is left at the right and lower edge is cut off.
ar::Image shrunk(const ar::Image& picture, int width);

}  // namespace gnomon::apps::study
