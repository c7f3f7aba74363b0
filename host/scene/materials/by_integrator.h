// Materials that differ between path tracing and the classical integrator.
#pragma once
#include <memory>

#include "scene/description.h"
#include "scene/integrators.h"

namespace sundog {

/// The variant of a material for the scene's integrator.
inline const MaterialDescription& surface_for(const SceneDescription& scene,
                                              const MaterialDescription& material) {
  const bool other = material.by_paths && traces_paths(scene.render.integrator);
  return other ? *material.by_paths : material;
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
