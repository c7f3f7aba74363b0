// Finds instances whose faces coincide with others, exactly or up to rounding.
#pragma once
#include <span>

#include "compile/bounds.h"
#include "compile/compiled_scene.h"
#include "scene/description.h"

namespace sundog {

/// An instance that is not a field, and its world bounds (unbounded for a plane).
struct PlacedBody {
  Instance* instance;
  Bounds box;
};

/// The largest coordinate for rounding at the camera: that of its position, rounded up to a power of two, so
/// that a camera that orbits causes no new search.
double camera_reach(const SceneDescription& scene, const dvec3& origin);

/// Sets Instance.touch of bodies that may have a face on one of another body, or of their own mesh, if at
/// least one of the two has an interior medium. Conservative: false positives only cost time. Sets
/// features.touching if any are marked. Boxes are relative to `origin`.
void mark_touching(const SceneDescription& scene, std::span<PlacedBody> bodies, const dvec3& origin,
                   SceneFeatures& features);

}  // namespace sundog
