// What is measured: a named scene at a size, the same triangles for every system.
// Invariant: a subject is a function of its name, its size and the given model files; nothing in it
// is random but what a fixed seed gives.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/scene.h"

namespace gnomon::bench {

struct Size {
  int width = 640, height = 480;
  bool operator==(const Size&) const = default;
};

/// "640x480".
std::string text(Size size);
/// Throws std::invalid_argument unless `text` is WIDTHxHEIGHT, each from 1 to 16384.
Size size_from(std::string_view text);

enum class Kind {
  /// The lit scene, its shadow volumes, the flat colour in the shadow.
  shadows,
  /// The scene into a depth buffer, without colour and stencil.
  depth,
  /// One layer over the whole screen, counted where it fails the depth test.
  layer
};

struct Subject {
  std::string name;
  Kind kind = Kind::shadows;
  Size size;
  /// One light, a point or a direction. Empty for a layer.
  pipeline::Scene scene;
  pipeline::Camera camera;
  /// The layer lies over random depths, so that no block of pixels decides as a whole.
  bool random_depth = false;
};

/// Throws std::invalid_argument for an unknown name, ar::InputError for a model that cannot be
/// read. Beside usual_subjects(): "tori-N" for up to 4096 tori, "grid-T" for twelve tori of about T
/// triangles together. `models` are added to the scene "meshes".
Subject make_subject(const std::string& name, Size size,
                     std::span<const std::filesystem::path> models = {});

struct UsualSubject {
  const char* name;
  const char* what;
  std::vector<Size> sizes;
};

/// What a run without arguments measures.
const std::vector<UsualSubject>& usual_subjects();

}  // namespace gnomon::bench
