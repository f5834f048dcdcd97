// The chart as one HTML file that works without a network, opened from disk.
#pragma once

#include <filesystem>
#include <string>

#include "apps/study/chart_point.h"

namespace gnomon::apps::study {

/// With Pareto fronts, a table, and each point's pictures, at most 320 pixels wide, from the folder
/// `pictures`. Throws ar::InputError about a picture that cannot be read.
std::string chart_page(const ChartPart& part, const std::filesystem::path& pictures);

}  // namespace gnomon::apps::study
