// Finds instances whose faces coincide with others, exactly or up to rounding: compile_touching() sets
// Instance.touch of instances that may have a face on one of another, or of their own mesh, if at least one
// of the two has an interior medium. Conservative: false positives only cost time.
#pragma once
#include "scene/description.h"

namespace sundog {

/// The largest coordinate for rounding at the camera: that of its position, rounded up to a power of two, so
/// that a camera that orbits causes no new search.
double camera_reach(const SceneDescription& scene, const dvec3& origin);

}  // namespace sundog
