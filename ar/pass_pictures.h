// What a frame's passes were and left in the buffers, for people.
#pragma once

#include <cstddef>
#include <string>

#include "ar/image.h"

namespace gnomon::ar {

/// The buffers after a pass.
struct PassPictures {
  std::string label;
  Image color, depth, stencil;
};

struct PassNote {
  std::string label;
  std::size_t commands = 0;
};

}  // namespace gnomon::ar
