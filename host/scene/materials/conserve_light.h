// Dims materials of model files that return more light than they receive.
#pragma once
#include <algorithm>

#include "models/values/lowering.h"
#include "models/values/material.h"

namespace sundog {

/// The share of uniform white light that a white highlight reflects to a viewer along the normal, where it is
/// greatest; 1 as an estimate if the exponent is textured.
inline double highlight_albedo(const MaterialDescription& m) {
  if (m.textures.exponent >= 0) return 1;
  return m.blinn ? lowering::highlight_energy(m.exponent) : 2 / (m.exponent + 1);
}

/// Dims a Phong material that returns more light than it receives, as many files specify; otherwise, light
/// along paths would grow between such surfaces.
inline void conserve_light(MaterialDescription& m) {
  if (m.type != MaterialType::phong || m.metal_rough || m.layers) return;
  const dvec3 returned = m.diffuse + highlight_albedo(m) * m.specular + m.reflection + m.transmission;
  const double most = std::max({returned.x, returned.y, returned.z});
  if (most <= 1) return;
  for (dvec3* part : {&m.diffuse, &m.specular, &m.reflection, &m.transmission}) *part /= most;
}

}  // namespace sundog
