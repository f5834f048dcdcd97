#include "raster/state_names.h"

#include <array>

namespace gnomon::raster {

namespace {

template <class Enum, std::size_t kCount>
std::string_view pick(const std::array<std::string_view, kCount>& names, Enum value) {
  return names.at(static_cast<std::size_t>(value));
}

}  // namespace

std::string_view name(CompareFunc func) {
  static constexpr std::array<std::string_view, 8> kNames{
      "never", "less", "equal", "less_equal", "greater", "not_equal", "greater_equal", "always"};
  return pick(kNames, func);
}

std::string_view name(StencilOp op) {
  static constexpr std::array<std::string_view, 8> kNames{
      "keep", "zero", "replace", "incr", "incr_wrap", "decr", "decr_wrap", "invert"};
  return pick(kNames, op);
}

std::string_view name(BlendOp op) {
  static constexpr std::array<std::string_view, 5> kNames{"add", "subtract", "reverse_subtract",
                                                          "min", "max"};
  return pick(kNames, op);
}

std::string_view name(BlendFactor factor) {
  static constexpr std::array<std::string_view, 15> kNames{"zero",
                                                           "one",
                                                           "src_color",
                                                           "one_minus_src_color",
                                                           "dst_color",
                                                           "one_minus_dst_color",
                                                           "src_alpha",
                                                           "one_minus_src_alpha",
                                                           "dst_alpha",
                                                           "one_minus_dst_alpha",
                                                           "constant_color",
                                                           "one_minus_constant_color",
                                                           "constant_alpha",
                                                           "one_minus_constant_alpha",
                                                           "src_alpha_saturate"};
  return pick(kNames, factor);
}

std::string_view name(Cull cull) {
  static constexpr std::array<std::string_view, 4> kNames{"none", "front", "back",
                                                          "front_and_back"};
  return pick(kNames, cull);
}

std::string_view kind(const Command& command) {
  static constexpr std::array<std::string_view, 3> kNames{"clear", "draw", "blit"};
  return kNames.at(command.index());
}

std::string_view label(const Command& command) {
  const auto* draw = std::get_if<Draw>(&command);
  return draw ? std::string_view(draw->label) : std::string_view();
}

}  // namespace gnomon::raster
