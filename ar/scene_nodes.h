// A scene file as a scene graph whose bodies are moved from picture to picture.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "ar/scene_file.h"
#include "ar/scene_models.h"
#include "pipeline/scene.h"
#include "pipeline/scene_graph.h"

namespace gnomon::ar {

class SceneNodes {
 public:
  /// `models`: load_models of the same scene. Bodies are not seen until they are placed.
  SceneNodes(const SceneFile& scene, const std::vector<ObjectModels>& models);

  /// Names of the bodies that something hangs on.
  std::vector<std::string> bodies() const;
  /// Absent: the body is not seen, and what hangs on it is not in the scene.
  void place(const std::string& body, const std::optional<glm::dmat4>& world_from_body);
  /// Names of the objects that hang on a body that is not seen.
  std::vector<std::string> left_out() const;

  /// The graph flattened, with the scene file's ambient light and way of lighting. Throws
  /// InputError about [[caster]] tables that contradict each other.
  pipeline::Scene scene() const;

 private:
  pipeline::NodePointer carrier(const std::string& name);
  void add_casters(const std::vector<SceneCaster>& casters);

  std::string file_;
  glm::vec3 ambient_;
  bool vertex_lighting_;
  pipeline::NodePointer root_;
  std::map<std::string, pipeline::NodePointer> bodies_, groups_, objects_, lights_;
};

}  // namespace gnomon::ar
