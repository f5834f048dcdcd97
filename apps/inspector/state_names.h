// OpenGL's names of a frame's state, without GL_ and in lower case, as raster/state.h spells them.
#pragma once

#include <string_view>

#include "raster/frame.h"

namespace gnomon::apps::inspector {

std::string_view name(raster::CompareFunc func);
std::string_view name(raster::StencilOp op);
std::string_view name(raster::BlendOp op);
std::string_view name(raster::BlendFactor factor);
std::string_view name(raster::Cull cull);
/// "clear", "draw" or "blit".
std::string_view kind(const raster::Command& command);
/// A draw's label; empty for others.
std::string_view label(const raster::Command& command);

}  // namespace gnomon::apps::inspector
