// A scene file's [shadow] in the methods' own terms.
#pragma once

#include "ar/scene_file.h"
#include "pipeline/make_volumes.h"

namespace gnomon::ar {

pipeline::VolumeMethod volume_method(ShadowMethod method);
pipeline::Extrusion extrusion(const VolumeReach& reach);

}  // namespace gnomon::ar
