// Chooses the targets of photons and each light's share of them (kernels/shared/photons.h).
#pragma once
#include "compile/steps.h"

namespace sundog {

struct Photons {
  SharedTable<PhotonTarget> photon_targets;
  SharedTable<float> photon_lights;
  PhotonPlan plan;
};

/// For path tracing with caustics in a scene with lights and smooth reflecting or refracting objects; else
/// nothing. `lights`: all of the scene.
Photons plan_photons(const AllLightsInputs& in, const std::vector<Light>& lights);

}  // namespace sundog
