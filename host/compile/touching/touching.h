// Which instances have faces in one place with others, exactly or to rounding.
#pragma once
#include <span>

#include "compile/bounds.h"
#include "compile/compiled_scene.h"
#include "scene/description.h"

namespace sundog {

/// An instance that is no field, and its bounds in the world (a plane has none).
struct PlacedBody {
  Instance* instance;
  Bounds box;
};

/// The greatest coordinate that rounding at the camera is taken to be relative to: that of its place, up to
/// the next power of two, so that a camera that turns about something asks for no new search.
double camera_reach(const SceneDescription& scene, const dvec3& origin);

/// Sets Instance.touch of the bodies that may have a face on one of another, or of their own mesh, where at
/// least one of the two has an interior medium. Errs on the safe side: what is marked only costs time. Sets
/// features.touching when there are any. Boxes count from `origin`.
void mark_touching(const SceneDescription& scene, std::span<PlacedBody> bodies, const dvec3& origin,
                   SceneFeatures& features);

}  // namespace sundog
