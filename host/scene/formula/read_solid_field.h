// Exact solids as operands of fields: the distance field of the same shape, moved to its place.
#pragma once
#include <string_view>

#include "scene/formula/sdf.h"
#include "scene/json/value.h"

namespace sundog {

/// Reads the keys of a solid ("sphere", "box", ...) and its "transform", which may move, turn and scale it
/// evenly. Throws SceneError for others, and for a solid without an inside.
SdfNode read_solid_field(JsonObject& object, std::string_view type);

}  // namespace sundog
