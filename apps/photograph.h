// One photograph through a session, for the commands that take one.
#pragma once

#include <filesystem>

#include "ar/image.h"
#include "ar/session.h"

namespace gnomon::apps {

/// What the session makes of the picture, which was read from `image`; the session's notes go to
/// the error stream. Throws ar::InputError if no virtual object could be placed.
ar::SessionResult augment_photograph(ar::Session& session, const ar::Image& picture,
                                     const std::filesystem::path& image);

}  // namespace gnomon::apps
