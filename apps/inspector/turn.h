// Sine and cosine that are the same on every machine: a library's own may differ in the last bit,
// and then the frames of a page and of the program would differ too.
#pragma once

namespace gnomon::apps::inspector {

struct Turn {
  double cosine = 1.0, sine = 0.0;
};

/// Of a finite angle; within 3e-15. Only operations that IEEE 754 rounds in one way, in a written
/// order.
Turn turn_of_degrees(double degrees);

}  // namespace gnomon::apps::inspector
