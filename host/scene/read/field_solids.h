// Exact solids as operands of fields: their distance fields, transformed.
#pragma once
#include <string_view>

#include "formula/sdf.h"
#include "scene/json/value.h"

namespace sundog {

/// Reads a solid ("sphere", "box", ...) and its "transform", which may translate, rotate and scale uniformly.
/// Throws SceneError for other transforms, and for a solid without an inside.
SdfNode read_solid_field(JsonObject& object, std::string_view type);

}  // namespace sundog
