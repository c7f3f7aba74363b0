// Distance fields from a scene's JSON.
#pragma once
#include <string>
#include <string_view>

#include "scene/formula/sdf.h"
#include "scene/json/value.h"

namespace sundog {

/// The "type"s of objects that are distance fields: fractal, formula, hybrid, union, ...
Names field_types();

/// Reads an object of one of these types, "type" itself apart. Formulas are checked and tried out here.
/// Throws SceneError; a place inside a formula's text is given by line and column.
SdfDescription read_field(JsonObject& object, std::string_view type);

/// An entry of the scene's table "fields": the same, its tree under "field".
SdfDescription read_named_field(const JsonValue& value, std::string name);

}  // namespace sundog
