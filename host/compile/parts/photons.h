// Chooses the targets of photons and each light's share of them (kernels/shared/photons.h).
#pragma once
#include <span>

#include "compile/compiled_scene.h"

namespace sundog {

/// Fills `out.photon_targets` and `out.photon_lights` and sets the feature, for path tracing with caustics in
/// a scene with lights and smooth reflecting or refracting objects; else does nothing. `boxes`: one per
/// instance of `out`, whose lights must be complete.
void add_photon_targets(const SceneDescription& scene, std::span<const Bounds> boxes, CompiledScene& out);

}  // namespace sundog
