// Reads the motion of objects and groups while the shutter is open.
#pragma once
#include "scene/json/value.h"
#include "scene/read/library.h"

namespace sundog {

/// Combines the keys "moves_by", "turns_by" and "grows_to" of an object with its groups' motion. A turn about
/// the object's middle is about its origin until turn_about_middle() corrects it.
void read_motion(JsonObject& object, const dmat4& world_from_parent, Placement& placement);

/// Moves the centre of a solid's own turn to the middle of its shape, unless the scene gives a point.
void turn_about_middle(const dmat4& world_from_object, Placement& placement);

}  // namespace sundog
