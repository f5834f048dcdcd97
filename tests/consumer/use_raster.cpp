// A stranger's program: two overlapping clears of a stencil buffer, read back.
#include <raster/execute.h>

int main() {
  using namespace gnomon::raster;
  StencilBuffer stencil(8, 8);
  Frame frame;
  frame.begin_pass("clears", {.stencil = &stencil});
  frame.clear({.stencil = 7});
  frame.clear({.stencil = 9, .scissor = Rect{4, 0, 4, 8}});
  execute(frame);
  return stencil.at(3, 0) == 7 && stencil.at(4, 0) == 9 ? 0 : 1;
}
