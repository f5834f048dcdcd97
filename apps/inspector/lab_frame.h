// A lab state as a scene and a recorded frame, with the shadow volumes as the student wants them:
// also such that are wrong.
#pragma once

#include <memory>

#include "apps/inspector/lab_state.h"
#include "pipeline/scene.h"
#include "pipeline/shadow_map.h"
#include "raster/buffers.h"
#include "raster/frame.h"

namespace gnomon::apps::inspector {

/// The frame and what it borrows.
struct LabFrame {
  pipeline::Scene scene;
  pipeline::Camera camera;
  raster::ColorBuffer color;
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;
  pipeline::MapMemory maps;
  raster::Frame frame;

  explicit LabFrame(const LabState& state);
  LabFrame(const LabFrame&) = delete;
  LabFrame& operator=(const LabFrame&) = delete;
};

/// Passes: "ambient pass", "shadow map: lamp" or "shadow volumes", "lit pass".
std::shared_ptr<LabFrame> record_lab(const LabState& state);

}  // namespace gnomon::apps::inspector
