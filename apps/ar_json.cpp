#include "apps/ar_json.h"

#include <cmath>

namespace gnomon::apps {

using nlohmann::json;

namespace {

json tag_json(const ar::TagId& id) { return {{"family", id.family}, {"id", id.number}}; }

json matrix_json(const glm::dmat4& m) {
  json rows = json::array();
  for (int r = 0; r < 4; ++r) rows.push_back({m[0][r], m[1][r], m[2][r], m[3][r]});
  return rows;
}

}  // namespace

json detections_json(const ar::TrackResult& track) {
  json list = json::array();
  for (const ar::Detection& d : track.detections) {
    json tag = tag_json(d.id);
    for (const glm::dvec2& c : d.corners_px) tag["corners_px"].push_back({c.x, c.y});
    list.push_back(tag);
  }
  return list;
}

json poses_json(const ar::SessionResult& result) {
  json poses = {{"world_from_camera", nullptr}, {"rms_px", nullptr}, {"bodies", json::array()}};
  if (result.world_from_camera) poses["world_from_camera"] = matrix_json(*result.world_from_camera);
  if (result.track.world.camera_from_body) poses["rms_px"] = result.track.world.rms_px;
  for (const ar::BodyTrack& body : result.track.bodies) {
    json entry = {{"name", body.name}, {"held", body.held}, {"world_from_body", nullptr}};
    if (body.world_from_body) {
      entry["world_from_body"] = matrix_json(*body.world_from_body);
      entry["rms_px"] = body.rms_px;
    }
    poses["bodies"].push_back(entry);
  }
  return poses;
}

json passes_json(const ar::Augmented& augmented) {
  json list = json::array();
  for (const ar::PassNote& pass : augmented.passes)
    list.push_back({{"label", pass.label}, {"commands", pass.commands}});
  return list;
}

json differential_json(const ar::DifferentialReport& report) {
  return {{"sources", report.occluded_sources},
          {"receivers", report.receivers},
          {"shadows", report.shadows},
          {"left_out", report.left_out}};
}

json stages_json(const ar::SessionResult& result) {
  const auto ms = [](double v) { return std::round(v * 1000.0) / 1000.0; };
  json stages = {{"track", ms(result.track_ms)}};
  if (const std::optional<ar::Augmented>& a = result.augmented) {
    stages["resample"] = ms(a->resample_ms);
    stages["record"] = ms(a->record_ms);
    stages["execute"] = ms(a->execute_ms);
    stages["composite"] = ms(a->composite_ms);
  }
  return stages;
}

}  // namespace gnomon::apps
