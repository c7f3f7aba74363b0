// Compiles materials and media.
#pragma once
#include "compile/steps.h"

namespace sundog {

/// Fills the media and materials of `out`, with a default one at the end where some object or mesh lacks
/// one. Returns its index, or NO_MATERIAL.
u32 add_materials(const SurfaceInputs& in, Surfaces& out);

/// Whether some object or mesh lacks a material.
bool lacks_materials(const SceneDescription& scene);

}  // namespace sundog
