#include "ar/map_keys.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "ar/toml_pose.h"
#include "raster/frame.h"

namespace gnomon::ar {

pipeline::ShadowMethod read_shadow_method(const TomlTable& t) {
  const std::string method = t.text("method").value_or("volumes");
  if (method == "volumes") return pipeline::ShadowMethod::volumes;
  if (method == "map") return pipeline::ShadowMethod::map;
  if (method == "alias-free") return pipeline::ShadowMethod::alias_free;
  if (method == "none") return pipeline::ShadowMethod::none;
  t.fail("method", fmt::format("'{}' is not one of volumes, map, alias-free, none", method));
}

pipeline::MapSettings read_map_settings(const TomlTable& t, pipeline::ShadowMethod method) {
  pipeline::MapSettings map;
  if (method != pipeline::ShadowMethod::map) {
    for (const char* key : {"size", "sides", "fov_deg", "near_m", "far_m", "displace_scale",
                            "displace_offset", "filter", "depth_bits"})
      if (t.has(key)) t.fail(key, "is a shadow map's: give method = \"map\"");
    return map;
  }
  map.size = t.integer("size", 1, raster::kMaxTargetSize);
  if (const auto sides = t.integer("sides", 1, 6)) {
    if (*sides != 1 && *sides != 6) t.fail("sides", fmt::format("{} is not 1 or 6", *sides));
    if (*sides == 6 && t.has("fov_deg")) t.fail("fov_deg", "is of one map, not of sides = 6");
    map.sides = *sides == 1 ? pipeline::MapSides::one : pipeline::MapSides::six;
  }
  if (const auto fov = t.number("fov_deg", 0.1, 170.0))
    map.fov_tangent = static_cast<float>(std::tan(glm::radians(*fov / 2.0)));
  if (t.has("near_m") || t.has("far_m")) {
    const double near = t.required("near_m", t.number("near_m", -kMaxMetres, kMaxMetres));
    const double far = t.required("far_m", t.number("far_m", -kMaxMetres, kMaxMetres));
    if (!(static_cast<float>(near) < static_cast<float>(far)))
      t.fail("far_m", fmt::format("{} is not beyond near_m {}", far, near));
    map.near_far_m = glm::vec2(near, far);
  }
  if (t.has("displace_scale") || t.has("displace_offset"))
    map.offset = raster::PolygonOffset{
        static_cast<float>(t.number("displace_scale", -1e6, 1e6).value_or(0.0)),
        static_cast<float>(t.number("displace_offset", -1e9, 1e9).value_or(0.0))};
  const std::string filter = t.text("filter").value_or("nearest");
  if (filter != "nearest" && filter != "linear")
    t.fail("filter", fmt::format("'{}' is not one of nearest, linear", filter));
  map.filter = filter == "linear" ? raster::Filter::linear : raster::Filter::nearest;
  const int bits = t.integer("depth_bits", 16, 24).value_or(24);
  if (bits != 16 && bits != 24) t.fail("depth_bits", fmt::format("{} is not 16 or 24", bits));
  map.format = bits == 16 ? raster::DepthFormat::d16 : raster::DepthFormat::d24;
  return map;
}

}  // namespace gnomon::ar
