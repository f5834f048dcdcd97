// The cases that a chart is made of, from files and from what the program makes itself.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "apps/study/captured_room.h"
#include "apps/study/chart_case.h"

namespace gnomon::apps::study {

/// Reads the files, but no picture or model. A study's photograph gives a case of soft shadows if
/// it names a capture; otherwise one of the photograph and one of its light's shadow by every
/// method. A scene file gives one a light. `rooms` outlives the cases. Throws ar::InputError, also
/// where two are called the same.
std::vector<std::unique_ptr<ChartCase>> chart_cases(const std::vector<std::filesystem::path>& files,
                                                    bool generated, CapturedRooms& rooms,
                                                    int threads);

}  // namespace gnomon::apps::study
