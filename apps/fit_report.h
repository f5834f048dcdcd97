// What gnomon fit found, for a program and for a person.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "ar/fit.h"

namespace gnomon::apps {

struct FitReport {
  std::filesystem::path scene;
  std::vector<std::filesystem::path> photographs;
  ar::ErrorBound bound;
  const ar::FitResult* result = nullptr;
  /// Of the scene that was written, read again and drawn.
  double written_error = 0.0;
};

/// Format "gnomon-fit 1" (docs/fit.md).
nlohmann::ordered_json fit_json(const FitReport& report);

/// The same as Markdown.
std::string fit_text(const FitReport& report);

}  // namespace gnomon::apps
