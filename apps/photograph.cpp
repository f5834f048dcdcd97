#include "apps/photograph.h"

#include <iostream>
#include <string>

#include <fmt/format.h>

#include "ar/error.h"

namespace gnomon::apps {

ar::SessionResult augment_photograph(ar::Session& session, const ar::Image& picture,
                                     const std::filesystem::path& image) {
  for (const std::string& note : session.notes()) std::cerr << "gnomon: note: " << note << '\n';
  ar::SessionResult result = session.process(picture, 0.0);
  if (!result.augmented)
    throw ar::InputError(
        fmt::format("{}: no pose for any virtual object: {} tags found, none of the scene's that "
                    "are needed ({})",
                    image.string(), result.track.detections.size(), session.known_tags()));
  return result;
}

}  // namespace gnomon::apps
