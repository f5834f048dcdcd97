// The text files that pages are put together from, as they were when the program was built.
#pragma once

#include <string_view>

namespace gnomon::apps::study {

extern const std::string_view kPageCss, kChartHtml, kChartScript, kStabilityHtml, kStabilityScript;
/// Chart.js (chartjs.org, MIT licence), minified.
extern const std::string_view kChartLibrary;

}  // namespace gnomon::apps::study
