// Compiles materials, media and lights.
#pragma once
#include <string>
#include <vector>

#include "compile/parts/steps.h"

namespace sundog {

/// Fills the media and materials of `out`, with a default one at the end where some object or mesh lacks
/// one. Returns its index, or NO_MATERIAL.
u32 add_materials(const SurfaceInputs& in, Surfaces& out);

/// Whether some object or mesh lacks a material.
bool lacks_materials(const SceneDescription& scene);

/// Fills the lights of the scene file and the ambient light.
void add_lights(const LightInputs& in, Lights& out);

/// Adds a non-ambient light; `place` is its place in the scene file.
void add_light(const LightInputs& in, const LightDescription& light, const std::string& place, Lights& out);

/// Whether the world's fog is a scattering medium instead of emitting light itself.
bool fog_scatters(const SceneDescription& scene);

}  // namespace sundog
