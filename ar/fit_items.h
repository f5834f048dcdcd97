// What of a scene can be less, one thing after another, each with its ways from the least to the
// exact one (docs/fit.md has the list).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "ar/fit_scene.h"

namespace gnomon::ar {

struct FitOption {
  std::string name;
  /// In the item's unit.
  double amount = 0.0;
  std::function<void(FitScene&)> apply;
};

struct FitItem {
  std::string name;
  /// What options have less of, such as triangles. Empty: options have nothing to count, and are
  /// told apart by the time they take alone.
  std::string unit;
  /// The least first; the last is the exact scene's.
  std::vector<FitOption> options;
  /// The option that the scene came with; as many as there are where it was left out.
  std::size_t given = 0;
  std::string given_name = {};
  double given_amount = 0.0;
  /// Of one object: its index, and nothing to do once the object is dropped.
  std::optional<std::size_t> object;
};

/// What was seen when the exact scene was drawn.
struct FitSurvey {
  bool photographs = false;
  /// Objects that are in a picture.
  std::set<std::string> placed;
  /// Passes that the exact scene takes.
  std::size_t passes = 0;
};

/// Reduces the models of what is placed, which takes a while for large ones.
std::vector<FitItem> fit_items(const FitScene& given, const FitSurvey& survey);

}  // namespace gnomon::ar
