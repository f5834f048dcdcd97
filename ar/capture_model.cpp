#include "ar/capture_model.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/gltf.h"

namespace gnomon::ar {
namespace {

/// Inverse of the sRGB curve, in which materials are kept (IEC 61966-2-1).
float linear_from_display(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

CaptureModel read_capture_model(const std::filesystem::path& file,
                                const std::vector<std::string>& leave_out) {
  GltfModel gltf = read_gltf(file);
  for (const std::string& name : leave_out)
    if (std::find(gltf.part_nodes.begin(), gltf.part_nodes.end(), name) == gltf.part_nodes.end())
      throw InputError(fmt::format("{}: no node '{}' with triangles, which is to be left out",
                                   one_line(file.string()), one_line(name)));
  CaptureModel result;
  result.notes = std::move(gltf.notes);
  std::map<std::string, int> used;
  for (std::size_t i = 0; i < gltf.model.parts.size(); ++i) {
    const std::string& node = gltf.part_nodes[i];
    if (std::find(leave_out.begin(), leave_out.end(), node) != leave_out.end()) continue;
    const int before = used[node]++;
    const glm::vec3 diffuse = gltf.model.parts[i].material.diffuse;
    result.reflectance.emplace_back(linear_from_display(diffuse.x), linear_from_display(diffuse.y),
                                    linear_from_display(diffuse.z));
    pipeline::Object object;
    object.name = before == 0 ? node : fmt::format("{} {}", node, before + 1);
    object.role = pipeline::Role::phantom;
    auto model = std::make_shared<pipeline::Model>();
    model->parts.push_back(std::move(gltf.model.parts[i]));
    object.model = std::move(model);
    result.scene.objects.push_back(std::move(object));
  }
  if (result.scene.objects.empty())
    throw InputError(fmt::format("{}: nothing is left of the model", one_line(file.string())));
  return result;
}

}  // namespace gnomon::ar
