// Items of a scene that are settings, not models. Internal to ar/fit_items.cpp.
#pragma once

#include <cstddef>
#include <vector>

#include "ar/fit_items.h"

namespace gnomon::ar {

/// Pixels that are drawn for a photograph's.
FitItem samples_item(const FitScene& given);

/// How volumes are counted and how long they are; points that stand for a light; without a
/// photograph also how each light's shadows are found.
std::vector<FitItem> volume_items(const FitScene& given, bool photographs);

/// Of differential shadows; `passes` are those of every source.
std::vector<FitItem> differential_items(const FitScene& given, std::size_t passes);

}  // namespace gnomon::ar
