// A picture of a tag on a table from any side, made by formula.
#pragma once

#include <glm/mat4x4.hpp>

#include "ar/camera.h"
#include "ar/image.h"
#include "ar/response.h"
#include "ar/tag_layout.h"

namespace gnomon::apps::study {

/// Tag 0 of the family tag36h11 in linear light, 16 samples a pixel, on a table of one colour.
/// Preconditions: the camera has a size; the tag is before the camera.
ar::Image picture_of_tag(const ar::Lens& lens, const glm::dmat4& camera_from_tag, double size_m,
                         const ar::Response& response);

/// OpenCV's axes: a camera that looks at a point from a distance, at an angle from the vertical,
/// from that side (0 along x, counter-clockwise seen from above); its picture's upper edge is away
/// from it.
glm::dmat4 world_from_camera_at(const glm::dvec3& at, double distance_m, double from_vertical_rad,
                                double side_rad);

}  // namespace gnomon::apps::study
