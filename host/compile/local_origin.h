// Where the tables' coordinates begin: floats are fine near 0 alone, and scenes lie anywhere.
#pragma once
#include "scene/description.h"
#include "shared/types.h"

namespace sundog {

/// The point of the world that the tables take for their origin. Along each axis it is 0 while the camera's
/// target lies within two lengths of the view (position to target) of it. Else it is the target to about half
/// that length, a round number, or that place of an object, light or the camera near the target from which
/// these are counted in fewer decimals: most likely the scene's own origin before it was moved, so that the
/// moved scene keeps its bits.
dvec3 local_origin(const SceneDescription& scene);

/// `offset` counted in whole multiples of `period` from which a pattern repeats, where it is far beside the
/// view's length; else 0. A `period` of 0 stands for any.
double far_part(double offset, double period, const Camera& camera);

/// `v` as two floats whose sum it is, as far as 48 bits go.
struct SplitPoint {
  float4 high, low;
};
SplitPoint split_point(const dvec3& v);

}  // namespace sundog
