// The exact solids as unit shapes (kernels/shared/bvh.h, SHAPE_*): what of a shape's size a transform can
// carry, what stays in parameters, and how far the unit shape reaches in a direction.
#pragma once
#include <array>

#include "compile/compiled_scene.h"

namespace sundog {

struct UnitShape {
  u32 shape = SHAPE_MESH;
  dvec3 scale{1};  // unit shape to the description's object space
  float4 parameters{};
};

/// Throws SceneError (at `object`'s place) for sizes that are not positive, and for a torus or rounded box
/// that cuts itself.
UnitShape unit_shape(const SceneDescription& scene, const Object& object);

/// Greatest dot(direction, p) over the points p of a bounded unit shape other than a mesh.
double reach(const UnitShape& unit, const dvec3& direction);

}  // namespace sundog
