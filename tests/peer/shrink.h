// A failing case cut down to its smallest (delta debugging, Zeller and Hildebrandt 2002): commands
// and triangles are left out, states set to their defaults, vertices moved to rounder values, as
// long as the case still fails. The result is minimal in the sense that no single one of these
// steps is possible any more.
#pragma once

#include <cstddef>
#include <functional>

#include "case.h"

namespace gnomon::peer {

using Fails = std::function<bool(const Case&)>;

/// Postcondition: fails(result). Precondition: fails(failing). `fails` is asked at most `questions`
/// times.
Case shrink(Case failing, const Fails& fails, std::size_t questions = 20000);

}  // namespace gnomon::peer
