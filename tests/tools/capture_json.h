// The JSON files of a capture set.
#pragma once

#include <filesystem>
#include <fstream>

#include <glm/mat4x4.hpp>
#include <nlohmann/json.hpp>

namespace gnomon {

inline nlohmann::json load_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in);
}

/// From four rows of four numbers.
inline glm::dmat4 matrix_of(const nlohmann::json& rows) {
  glm::dmat4 m(1.0);
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) m[c][r] = rows.at(r).at(c).get<double>();
  }
  return m;
}

}  // namespace gnomon
