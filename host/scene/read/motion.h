// How objects and groups move while the shutter is open.
#pragma once
#include "scene/json/value.h"
#include "scene/read/library.h"

namespace sundog {

/// Adds the keys "moves_by", "turns_by" and "grows_to" of an object to what its groups do. What turns about
/// its own middle turns about its origin, until turn_about_middle() knows better.
void read_motion(JsonObject& object, const dmat4& world_from_parent, Placement& placement);

/// A solid's own turn is about the middle of its shape, which it places there, unless it says where.
void turn_about_middle(const dmat4& world_from_object, Placement& placement);

}  // namespace sundog
