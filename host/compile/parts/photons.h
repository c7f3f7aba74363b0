// Where photons are sent to, and which lights send how many (kernels/shared/photons.h).
#pragma once
#include <span>

#include "compile/compiled_scene.h"

namespace sundog {

/// Fills `out.photon_targets` and `out.photon_lights` and sets the feature, for a scene that is path-traced
/// with caustics and has both lights and smooth things that mirror or bend light; else nothing. `boxes`: of
/// each instance of `out`, whose lights are complete.
void add_photon_targets(const SceneDescription& scene, std::span<const Bounds> boxes, CompiledScene& out);

}  // namespace sundog
