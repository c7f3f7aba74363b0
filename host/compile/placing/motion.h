// Objects while the shutter is open: where they are at a time, all that they pass, and the kernels' rows of
// their turns.
#pragma once
#include <span>
#include <vector>

#include "compile/placing/instance_bounds.h"
#include "scene/description.h"
#include "shared/bvh.h"

namespace sundog {

/// Takes points of the world where an object is when the shutter opens to where it has them at `time`, from 0
/// to 1.
dmat4 world_at(const Object& object, double time);

/// A bounded shape's box in the world wherever the object is while the shutter is open. As world_bounds();
/// the world's points count from `origin`.
Bounds moving_bounds(const Object& object, const UnitShape& unit, std::span<const Bounds> boxes,
                     const dmat4& world_from_unit, const dvec3& origin);

/// Appends the object's turns. Returns its row of the table `moves`. Throws SceneError for numbers that
/// single precision does not hold.
float4 add_motion(const SceneDescription& scene, const Object& object, const dvec3& origin,
                  std::vector<Turn>& turns);

}  // namespace sundog
