// OpenGL's names of a frame's state, without GL_ and in lower case, as raster/state.h spells them.
#pragma once

#include <string_view>

#include "raster/frame.h"

namespace gnomon::raster {

std::string_view name(CompareFunc func);
std::string_view name(StencilOp op);
std::string_view name(BlendOp op);
std::string_view name(BlendFactor factor);
std::string_view name(Cull cull);
/// "clear", "draw" or "blit".
std::string_view kind(const Command& command);
/// A draw's label; empty for others.
std::string_view label(const Command& command);

}  // namespace gnomon::raster
