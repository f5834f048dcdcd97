// Poses as a scene file has them (docs/scene.md).
#pragma once

#include <string_view>

#include <glm/mat4x4.hpp>

#include "ar/toml_table.h"

namespace gnomon::ar {

/// Of any coordinate of a scene.
inline constexpr double kMaxMetres = 1e6;

/// A pose under `matrix_key`, or from position_m with rotation_deg or quaternion. With `scalable`,
/// the matrix may scale and there may be a scale. Absent keys are the identity. Throws InputError.
glm::dmat4 read_pose(const TomlTable& t, std::string_view matrix_key, bool scalable);

/// The pose under world_from_camera, which `axes` says to be in OpenCV's (the default) or OpenGL's
/// axes, in OpenCV's. Throws InputError, also where it is no rotation and translation.
glm::dmat4 read_world_from_camera(const TomlTable& t);

/// world_from_camera, in OpenCV's axes (x right, y down, z forward), of eye_m, target_m and up
/// (default +y). Throws InputError.
glm::dmat4 read_look_at(const TomlTable& t);

}  // namespace gnomon::ar
