// Chooses the targets of photons and each light's share of them (kernels/shared/photons.h).
#pragma once
#include <span>

#include "compile/compiled_scene.h"

namespace sundog {

struct Photons {
  SharedTable<PhotonTarget> photon_targets;
  SharedTable<float> photon_lights;
  PhotonPlan plan;
};

/// For path tracing with caustics in a scene with lights and smooth reflecting or refracting objects; else
/// nothing. `boxes`: one per instance of `scene`, whose other tables must be complete.
Photons plan_photons(const SceneDescription& description, std::span<const Bounds> boxes,
                     const CompiledScene& scene);

}  // namespace sundog
