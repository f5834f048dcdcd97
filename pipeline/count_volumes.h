// Shadow volumes of a scene, and the draws that count them in the stencil buffer (Haller 2003,
// section 3.1.2 and appendix A; depth fail after Everitt and Kilgard 2002).
// Invariant: after the counts a pixel's stencil is 0 (modulo 256, or 128 under a 7-bit write mask)
// exactly when its visible point lies in no counted volume.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/near_clip.h"
#include "pipeline/placed_object.h"
#include "pipeline/receivers.h"
#include "pipeline/shadow_volume.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

/// How long volumes are.
struct Extrusion {
  /// Far enough for every receiver and no further; to infinity; by the paper's radius.
  enum class Kind : std::uint8_t { automatic, infinite, radius };
  Kind kind = Kind::automatic;
  /// Metres beyond the caster, for `radius`.
  float radius_m = 1.0f;
};

/// One caster's volume of one light, ready to be counted.
struct PlacedVolume {
  std::shared_ptr<const ShadowVolume> volume;
  const Object* caster = nullptr;
  glm::mat4 clip_from_model{1.0f};
  raster::FrontFace front_face = raster::FrontFace::ccw;
  /// zpass or zfail.
  VolumeMethod method = VolumeMethod::zfail;
  /// What the automatic extrusion took; absent for the others.
  std::optional<Reach> reach;
};

struct VolumeOptions {
  VolumeMethod method = VolumeMethod::automatic;
  Extrusion extrusion;
};

/// The volumes of all casters in `objects`, in their order; casters whose volume is empty (nothing
/// faces the light, or no receiver lies behind) are left out.
/// `light` is taken as a point (or direction): see light_samples.h.
std::vector<PlacedVolume> make_volumes(std::span<const PlacedObject> objects, const Light& light,
                                       const Receivers& receivers,
                                       const std::optional<NearRegion>& region,
                                       const VolumeOptions& options);

struct CountOptions {
  /// Appendix A to the letter: single-sided draws with culling and saturating INCR and DECR, all
  /// increments before all decrements. Otherwise one two-sided draw a volume with wrapping
  /// operations.
  bool appendix_letter = false;
  /// Stencil bits that count.
  std::uint8_t write_mask = 0xff;
  /// Added to each draw's label.
  std::string light_name;
};

/// Records the counting draws: colour and depth are only read.
/// z-pass: +1 for a front face, -1 for a back face that passes the depth test. z-fail: +1 for a
/// back face, -1 for a front face that fails it. Both with LESS: a front cap coincides with its
/// caster's lit surface, which must come out as not in the volume.
void count_volumes(raster::Frame& frame, std::span<const PlacedVolume> volumes,
                   const CountOptions& options);

}  // namespace gnomon::pipeline
