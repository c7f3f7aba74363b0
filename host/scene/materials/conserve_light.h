// Materials of files that return more light than they get.
#pragma once
#include <algorithm>

#include "models/values/lowering.h"
#include "models/values/material.h"

namespace sundog {

/// The part of uniform white light that a highlight of white sends to a viewer along the normal, its maximum;
/// with a texture of exponents an estimate.
inline double highlight_albedo(const MaterialDescription& m) {
  if (m.textures.exponent >= 0) return 1;
  return m.blinn ? lowering::highlight_energy(m.exponent) : 2 / (m.exponent + 1);
}

/// Dims a Phong material that returns more light than it gets, as many files say: along paths light would
/// grow between such surfaces.
inline void conserve_light(MaterialDescription& m) {
  if (m.type != MaterialType::phong || m.metal_rough || m.layers) return;
  const dvec3 returned = m.diffuse + highlight_albedo(m) * m.specular + m.reflection + m.transmission;
  const double most = std::max({returned.x, returned.y, returned.z});
  if (most <= 1) return;
  for (dvec3* part : {&m.diffuse, &m.specular, &m.reflection, &m.transmission}) *part /= most;
}

}  // namespace sundog
