#include "ar/shadow_settings.h"

#include <variant>

namespace gnomon::ar {

pipeline::VolumeMethod volume_method(ShadowMethod method) {
  switch (method) {
    case ShadowMethod::zpass:
      return pipeline::VolumeMethod::zpass;
    case ShadowMethod::zfail:
      return pipeline::VolumeMethod::zfail;
    case ShadowMethod::automatic:
      break;
  }
  return pipeline::VolumeMethod::automatic;
}

pipeline::Extrusion extrusion(const VolumeReach& reach) {
  using Kind = pipeline::Extrusion::Kind;
  if (const double* radius_m = std::get_if<double>(&reach))
    return {Kind::radius, static_cast<float>(*radius_m)};
  return {std::holds_alternative<InfiniteReach>(reach) ? Kind::infinite : Kind::automatic};
}

}  // namespace gnomon::ar
