#include "compare.h"

#include <algorithm>

namespace gnomon::peer {

namespace {

template <class T>
std::size_t count_differing(const std::vector<T>& a, const std::vector<T>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

bool same_color(const Buffers& a, const Buffers& b, std::size_t pixel) {
  return std::equal(&a.color[4 * pixel], &a.color[4 * pixel] + 4, &b.color[4 * pixel]);
}

std::string color_text(const Buffers& buffers, std::size_t pixel) {
  std::string text = "(";
  for (std::size_t c = 0; c < 4; ++c)
    text += (c ? ", " : "") + std::to_string(buffers.color[4 * pixel + c]);
  return text + ")";
}

}  // namespace

Differing& Differing::operator+=(const Differing& other) {
  stencil += other.stencil;
  depth += other.depth;
  color += other.color;
  return *this;
}

Differing compare(const Buffers& a, const Buffers& b) {
  return {count_differing(a.stencil, b.stencil), count_differing(a.depth, b.depth),
          count_differing(a.color, b.color)};
}

std::string values_at(const Buffers& ours, const Buffers& theirs, std::size_t pixel) {
  return "gnomon: stencil " + std::to_string(ours.stencil[pixel]) + ", depth " +
         std::to_string(ours.depth[pixel]) + ", colour " + color_text(ours, pixel) +
         "; OpenGL: stencil " + std::to_string(theirs.stencil[pixel]) + ", depth " +
         std::to_string(theirs.depth[pixel]) + ", colour " + color_text(theirs, pixel);
}

std::optional<Disagreement> first_difference(const Buffers& ours, const Buffers& theirs, int width,
                                             std::size_t commands) {
  for (std::size_t i = 0; i < ours.stencil.size(); ++i) {
    if (ours.stencil[i] == theirs.stencil[i] && ours.depth[i] == theirs.depth[i] &&
        same_color(ours, theirs, i))
      continue;
    return Disagreement{commands, static_cast<int>(i) % width, static_cast<int>(i) / width,
                        values_at(ours, theirs, i)};
  }
  return std::nullopt;
}

Comparison compare_on_opengl(const OsmesaContext& context, const Case& tried,
                             std::size_t commands_a_look) {
  Recording recording(tried);
  Comparison out;
  reset(context);
  const std::size_t count = tried.commands.size();
  for (std::size_t first = 0; first < count; first += commands_a_look) {
    const std::size_t end = std::min(first + commands_a_look, count);
    recording.execute(first, end);
    for (std::size_t i = first; i < end; ++i)
      replay(context, recording.pass(i), &recording.color());
    const Buffers ours = recording.read(), theirs = read_back(context);
    const Differing differing = compare(ours, theirs);
    ++out.looks;
    out.differing += differing;
    if (differing.all() > 0 && !out.first)
      out.first = first_difference(ours, theirs, recording.width(), end);
  }
  return out;
}

}  // namespace gnomon::peer
