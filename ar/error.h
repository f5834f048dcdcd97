// The one exception for what comes from outside: a sentence that names the file, the place and the
// value.
#pragma once

#include <stdexcept>

namespace gnomon::ar {

/// Thrown when a file, image, camera, video or scene cannot be used. what() is one line for a
/// person: "FILE: PLACE: what is wrong with VALUE". Caught once, in apps/.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace gnomon::ar
