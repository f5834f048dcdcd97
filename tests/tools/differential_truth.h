// A captured room with photographs of real objects in it, and what differential shadows are held
// against there: the photographs, and rays with the same inputs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "ar/camera.h"
#include "ar/image.h"
#include "pipeline/differential_reference.h"
#include "pipeline/lit_scene.h"
#include "pipeline/scene.h"

namespace gnomon::ar {

struct Truth {
  std::string name;
  Image photo, object_mask;
  pipeline::Scene scene;
};

struct TruthSet {
  std::shared_ptr<const pipeline::LitScene> lit;
  CameraModel camera;
  glm::dmat4 world_from_camera{1.0};
  Image background;
  std::vector<Truth> truths;
};

/// `capture` has background.png, camera.yml and camera_pose.json, and the models; `truth` a folder
/// for each photograph with photo.png, pose.json and object_mask.png.
TruthSet read_truths(const std::filesystem::path& lit, const std::filesystem::path& capture,
                     const std::filesystem::path& truth);

/// One a pixel of the photograph.
std::vector<pipeline::Ray> photo_rays(const TruthSet& set);

/// Rays' picture; read from `folder` if it lies there, written to it otherwise.
pipeline::ReferencePicture reference_of(const TruthSet& set, const Truth& truth,
                                        const std::vector<pipeline::Ray>& rays,
                                        const std::filesystem::path& folder);

/// Pixels in the shadow: the reference takes two values or more in some channel, and no virtual
/// object touches them in photograph or model.
std::vector<std::size_t> shadow_region(const Truth& truth,
                                       const pipeline::ReferencePicture& reference,
                                       const Image& background);

/// Over the region, values of 255.
double rmse(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
            const std::vector<std::size_t>& region);
/// Mean of a - b.
double mean_difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
                       const std::vector<std::size_t>& region);

}  // namespace gnomon::ar
