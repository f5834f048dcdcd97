// Where two pictures differ, for people.
#pragma once

#include "ar/image.h"

namespace gnomon::apps::study {

/// `test` in faint grey; red where it is darker than the reference, blue where it is lighter, by
/// eight times the mean difference of the channels. Precondition: three channels, one size.
ar::Image difference_picture(const ar::Image& reference, const ar::Image& test);

}  // namespace gnomon::apps::study
