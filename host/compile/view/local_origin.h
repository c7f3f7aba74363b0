// The origin of the tables' coordinates. Floats are precise only near 0, but scenes may lie anywhere.
#pragma once
#include "scene/description.h"
#include "shared/types.h"

namespace sundog {

/// The world position of the tables' origin. Along each axis it is 0 while the camera's target is within two
/// view lengths (position to target) of 0. Otherwise it is the target rounded to about half that length, or
/// the position of an object, a light or the camera near the target relative to which all have fewer
/// decimals: most likely the scene's own origin before it was moved, so that a moved scene keeps its bits.
dvec3 local_origin(const SceneDescription& scene);

/// `offset` rounded to a multiple of `period`, at which a pattern repeats, if it is far relative to the
/// view's length; otherwise 0. `period` 0: any step.
double far_part(double offset, double period, const Camera& camera);

/// `v` as a sum of two floats, accurate to 48 bits.
struct SplitPoint {
  float4 high, low;
};
SplitPoint split_point(const dvec3& v);

}  // namespace sundog
