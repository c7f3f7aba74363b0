// Materials that differ between path tracing and the classical integrator.
#pragma once
#include <algorithm>
#include <memory>

#include "models/values/lowering.h"
#include "models/values/material.h"

namespace sundog {

/// The variant of a material for path tracing or the classical integrator.
inline const MaterialDescription& surface_for(bool paths, const MaterialDescription& material) {
  return material.by_paths && paths ? *material.by_paths : material;
}

/// The part of uniform white light that a highlight of white sends to a viewer along the normal, its maximum;
/// with a texture of exponents an estimate.
inline double highlight_albedo(const MaterialDescription& m) {
  if (m.textures.exponent >= 0) return 1;
  return m.blinn ? lowering::highlight_energy(m.exponent) : 2 / (m.exponent + 1);
}

/// Gives a Phong material that returns more light than it gets, as many files say, a dimmer one for paths:
/// between such surfaces light would grow.
inline void conserve_light(MaterialDescription& m) {
  if (m.type != MaterialType::phong || m.metal_rough || m.layers || m.by_paths) return;
  const dvec3 returned = m.diffuse + highlight_albedo(m) * m.specular + m.reflection + m.transmission;
  const double most = std::max({returned.x, returned.y, returned.z});
  if (most <= 1) return;
  auto dimmer = std::make_shared<MaterialDescription>(m);
  for (dvec3* part : {&dimmer->diffuse, &dimmer->specular, &dimmer->reflection, &dimmer->transmission})
    *part /= most;
  m.by_paths = std::move(dimmer);
}

}  // namespace sundog
