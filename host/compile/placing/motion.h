// Motion of objects while the shutter is open: transforms by time, swept bounds, and rows of turns for
// kernels.
#pragma once
#include <span>
#include <vector>

#include "compile/placing/instance_bounds.h"
#include "scene/description.h"
#include "shared/bvh.h"

namespace sundog {

/// Maps world points of an object when the shutter opens to their position at `time`, from 0 to 1.
dmat4 world_at(const Object& object, double time);

/// A bounded shape's world box over the whole shutter interval, like world_bounds(), relative to `origin`.
Bounds moving_bounds(const Object& object, const UnitShape& unit, std::span<const Bounds> boxes,
                     const dmat4& world_from_unit, const dvec3& origin);

/// Appends the object's turns. Returns its row of the table `moves`. Throws SceneError for numbers outside
/// the range of floats.
float4 add_motion(const std::string& file, const Object& object, const dvec3& origin,
                  std::vector<Turn>& turns);

}  // namespace sundog
