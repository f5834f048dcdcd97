// How a caster's shadow is found, as a scene file has it (docs/scene.md, [[caster]]).
#pragma once

#include "ar/toml_table.h"
#include "pipeline/map_settings.h"
#include "pipeline/scene.h"

namespace gnomon::ar {

/// `method`; volumes without it. Throws InputError.
pipeline::ShadowMethod read_shadow_method(const TomlTable& t);

/// The keys of a map; what is absent is found from the scene. Throws InputError, also for
/// a key of maps where the method is another.
pipeline::MapSettings read_map_settings(const TomlTable& t, pipeline::ShadowMethod method);

}  // namespace gnomon::ar
