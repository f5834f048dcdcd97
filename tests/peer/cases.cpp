#include "cases.h"

#include <array>

namespace gnomon::peer {

std::string_view name(Kind kind) {
  constexpr std::array<std::string_view, 3> kNames{"grid", "free", "lookup"};
  return kNames.at(static_cast<std::size_t>(kind));
}

Case make_case(Kind kind, std::uint32_t seed) {
  if (kind == Kind::grid) return grid_case(seed);
  if (kind == Kind::free) return free_case(seed);
  return lookup_case(seed);
}

}  // namespace gnomon::peer
