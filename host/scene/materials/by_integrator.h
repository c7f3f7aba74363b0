// Materials that differ between path tracing and the classical integrator.
#pragma once
#include <memory>

#include "models/values/material.h"

namespace sundog {

/// The variant of a material for path tracing or the classical integrator.
inline const MaterialDescription& surface_for(bool paths, const MaterialDescription& material) {
  return material.by_paths && paths ? *material.by_paths : material;
}

/// Calls change(material) for every variant of a material.
template <class Change>
void change_all(MaterialDescription& material, const Change& change) {
  change(material);
  if (!material.by_paths) return;
  auto other = std::make_shared<MaterialDescription>(*material.by_paths);
  change(*other);
  material.by_paths = std::move(other);
}

}  // namespace sundog
