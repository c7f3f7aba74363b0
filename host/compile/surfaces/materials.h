// Compiles materials and media.
#pragma once
#include "compile/steps.h"

namespace sundog {

/// Fills the media and materials of `out`. If some object or mesh lacks a material, appends a default one and
/// returns its index, else NO_MATERIAL.
u32 add_materials(const SurfaceInputs& in, Surfaces& out);

/// Whether some object or mesh lacks a material.
bool lacks_materials(const SceneDescription& scene);

}  // namespace sundog
