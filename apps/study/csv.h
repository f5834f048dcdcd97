// A value of a comma separated file (RFC 4180).
#pragma once

#include <string>

namespace gnomon::apps::study {

inline std::string csv_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

}  // namespace gnomon::apps::study
