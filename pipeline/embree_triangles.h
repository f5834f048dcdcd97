// Triangles as Embree takes them. Internal to pipeline/: shows Embree.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include <embree3/rtcore.h>
#include <glm/vec3.hpp>

namespace gnomon::pipeline {

/// A committed geometry that holds copies of both; whoever asks releases it.
/// Precondition: neither is empty; three indices a triangle.
inline RTCGeometry make_triangles(RTCDevice device, std::span<const glm::vec3> corners,
                                  std::span<const std::uint32_t> indices) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* to_corners = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners.size()));
  auto* to_indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), indices.size() / 3));
  for (const glm::vec3& p : corners) {
    *to_corners++ = p.x;
    *to_corners++ = p.y;
    *to_corners++ = p.z;
  }
  std::ranges::copy(indices, to_indices);
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace gnomon::pipeline
