// The chart as one SVG file, a panel a scene.
#pragma once

#include <filesystem>

#include "apps/study/chart_point.h"

namespace gnomon::apps::study {

/// The main error of each scene against time, with Pareto fronts. Nothing is written where nothing
/// was timed. Errors: as plot().
void plot_chart(const std::filesystem::path& file, const ChartPart& part);

/// Points that no other one beats both in time and in the main error, from the fastest on; those
/// that were not timed are none.
std::vector<const ChartPoint*> pareto_front(const std::vector<const ChartPoint*>& points);

}  // namespace gnomon::apps::study
