// The dark end of a camera's response, where noise is larger than the steps between values.
// Read noise makes black pixels of short exposures take all dark values, so that the mean exposure
// of the pixels with such a value says more about how many black pixels there were than about the
// response. The other way round nothing is lost: of pixels whose exposure is known from longer
// exposures, the median value is the response's, because noise moves a median neither when the
// curve bends it nor when black cuts it off.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "ar/brackets.h"

namespace gnomon::ar {

/// Values from here on are taken as known.
inline constexpr std::size_t kFirstKnownValue = 24;

/// Gives `curve` (exposure of each value of the channel) its entries below kFirstKnownValue from
/// the entries above; where pixels do not tell, the curve goes on as a power law. Holds afterwards:
/// these entries rise from 0 at value 0 to below the first known.
void fit_dark_values(std::span<const Brackets> sets, std::size_t channel, int threads,
                     std::array<double, 256>& curve);

}  // namespace gnomon::ar
