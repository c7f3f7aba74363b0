// Chooses the targets of photons and each light's share of them (kernels/shared/photons.h).
#pragma once
#include "compile/steps.h"

namespace sundog {

struct Photons {
  SharedTable<PhotonTarget> photon_targets;
  SharedTable<float> photon_lights;
  PhotonPlan plan;
};

/// Plans photons for path tracing with caustics, if there are lights and smooth objects that reflect or
/// refract; otherwise returns nothing. `lights`: all lights of the scene.
Photons plan_photons(const AllLightsInputs& in, const std::vector<Light>& lights);

}  // namespace sundog
