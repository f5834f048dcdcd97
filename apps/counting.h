// How volumes are counted, by the name that a command's option has.
#pragma once

#include <optional>
#include <string>

#include "pipeline/near_clip.h"

namespace gnomon::apps {

/// Of zpass, zfail and auto; absent for any other text.
inline std::optional<pipeline::VolumeMethod> counting_named(const std::string& name) {
  if (name == "zpass") return pipeline::VolumeMethod::zpass;
  if (name == "zfail") return pipeline::VolumeMethod::zfail;
  if (name == "auto") return pipeline::VolumeMethod::automatic;
  return std::nullopt;
}

}  // namespace gnomon::apps
