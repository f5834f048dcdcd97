#include "ar/picture_error.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "ar/displacement.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/flip.h"

namespace gnomon::ar {

namespace {

/// 255 where either picture is not the untouched one.
Image touched(const Image& reference, const Image& test, const Image& untouched) {
  Image mask{test.width, test.height, 1, {}};
  const std::size_t pixels = std::size_t(test.width) * test.height;
  mask.pixels.assign(pixels, 0);
  for (std::size_t i = 0; i < 3 * pixels; ++i)
    if (reference.pixels[i] != untouched.pixels[i] || test.pixels[i] != untouched.pixels[i])
      mask.pixels[i / 3] = 255;
  return mask;
}

}  // namespace

ErrorBound parse_error_bound(std::string_view text) {
  ErrorBound bound;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bound.value);
  const std::string_view unit(end, text.data() + text.size());
  const bool is_flip = unit == "flip";
  if (is_flip) bound.unit = ErrorUnit::flip;
  const double most = is_flip ? 1.0 : DisplacementOptions{}.radius;
  if (error != std::errc() || (unit != "px" && !is_flip) || !std::isfinite(bound.value) ||
      !(bound.value > 0.0) || bound.value > most)
    throw InputError(fmt::format(
        "--error {}: is neither pixels above 0 and up to {}, such as 1px, nor FLIP above 0 and up "
        "to 1, such as 0.02flip",
        one_line(text.substr(0, 80)), DisplacementOptions{}.radius));
  return bound;
}

double picture_error(ErrorUnit unit, const Image& reference, const Image& test,
                     const Image& untouched) {
  if (unit == ErrorUnit::pixels) return displacement(reference, test).px;
  if (reference.pixels == test.pixels) return 0.0;
  const Image mask = touched(reference, test, untouched);
  return mean_error(flip(reference, test), &mask);
}

std::string describe_error(ErrorUnit unit, double error) {
  if (unit == ErrorUnit::flip) return fmt::format("{:.4f} FLIP", error);
  if (!std::isfinite(error)) return fmt::format("more than {} px", DisplacementOptions{}.radius);
  return fmt::format("{:.2f} px", error);
}

}  // namespace gnomon::ar
