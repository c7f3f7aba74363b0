// Reads distance fields from a scene's JSON.
#pragma once
#include <string>
#include <string_view>

#include "formula/sdf.h"
#include "scene/json/value.h"

namespace sundog {

/// Object types that are distance fields: fractal, formula, hybrid, union, ...
Names field_types();

/// Reads an object of such a type, except for its "type". Checks and surveys formulas. Throws SceneError; a
/// place inside a formula is given by line and column.
SdfDescription read_field(JsonObject& object, std::string_view type);

/// Reads an entry of the scene's "fields" table, whose tree is under "field".
SdfDescription read_named_field(const JsonValue& value, std::string name);

}  // namespace sundog
