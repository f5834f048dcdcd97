// Draws that touch every pixel of the targets: two triangles in clip space.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "raster/frame.h"

namespace gnomon::pipeline {

/// A quad on the far plane (depth 1.0) over the whole target, white. With depth test GREATER it
/// touches exactly the pixels on which a surface was drawn.
raster::Draw full_screen_quad(raster::Frame& frame, std::string label);

/// Depth state for such a quad: only where a surface is, and depth stays.
raster::DepthState where_a_surface_is();

/// The stencil bit that flag_counts sets.
inline constexpr std::uint8_t kCounted = 0x80;

/// Sets bit 7 and clears the others where any of the low 7 bits is set (counts become a flag).
void flag_counts(raster::Frame& frame);

/// The same where any bit of `counts` is set, with the highest bit of `bits`, of which the others
/// are cleared; bits beside those stay.
void flag_counts(raster::Frame& frame, std::uint8_t counts, std::uint8_t bits);

/// Zeroes the stencil where bit 7 is set.
void drop_flagged(raster::Frame& frame);

/// The picture as a texture without filtering, texel centres on pixel centres when drawn by
/// photograph_quad.
std::shared_ptr<const raster::Texture> photograph_texture(const raster::ImageView& photograph);

/// A full-screen quad that shows the photograph, pixel on pixel, times `factor`.
/// Precondition: the targets have the photograph's size.
raster::Draw photograph_quad(raster::Frame& frame, std::shared_ptr<const raster::Texture> texture,
                             float factor, std::string label);

}  // namespace gnomon::pipeline
