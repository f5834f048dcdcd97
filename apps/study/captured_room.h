// A real room's light, and the differential method at work in it with every setting: shared by all
// the photographs of that room.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "apps/study/placed_photograph.h"
#include "ar/camera.h"
#include "ar/differential_augment.h"
#include "pipeline/lit_scene.h"

namespace gnomon::apps::study {

struct DifferentialSetting {
  std::string name, family;
  ar::DifferentialSettings settings;
};

/// The paper's 5 to 50 sources and on to all, by volumes and by maps; precisions; reduced casters;
/// and the paper to the letter.
std::vector<DifferentialSetting> differential_settings();

class CapturedRoom {
 public:
  /// Finds the light of the capture folder. Throws ar::InputError.
  CapturedRoom(const std::filesystem::path& capture, int threads);

  const std::shared_ptr<const pipeline::LitScene>& light() const { return light_; }

  /// Made when it is first asked for. The camera stands still at the photograph's place.
  ar::DifferentialAugmenter& augmenter(const DifferentialSetting& setting,
                                       const PlacedPhotograph& photograph);

 private:
  std::shared_ptr<const pipeline::LitScene> light_;
  int threads_;
  struct Made {
    std::string name;
    ar::CameraModel camera;
    glm::dmat4 world_from_camera;
    double near_m, far_m;
    ar::DifferentialAugmenter augmenter;
  };
  std::vector<std::unique_ptr<Made>> made_;
};

/// Rooms by their folder, each found once.
class CapturedRooms {
 public:
  explicit CapturedRooms(int threads) : threads_(threads) {}
  CapturedRoom& room(const std::filesystem::path& capture);

 private:
  int threads_;
  std::map<std::filesystem::path, std::unique_ptr<CapturedRoom>> rooms_;
};

}  // namespace gnomon::apps::study
