// What `gnomon ar --json` prints of a picture.
#pragma once

#include <nlohmann/json.hpp>

#include "ar/session.h"

namespace gnomon::apps {

/// [{family, id, corners_px}]
nlohmann::json detections_json(const ar::TrackResult& track);

/// {world_from_camera: 4x4 rows or null, rms_px, bodies: [{name, held, world_from_body, rms_px}]};
/// OpenCV's camera axes.
nlohmann::json poses_json(const ar::SessionResult& result);

/// [{label, commands}]
nlohmann::json passes_json(const ar::Augmented& augmented);

/// {sources, receivers, shadows, left_out}
nlohmann::json differential_json(const ar::DifferentialReport& report);

/// Milliseconds a stage, to microseconds.
nlohmann::json stages_json(const ar::SessionResult& result);

}  // namespace gnomon::apps
