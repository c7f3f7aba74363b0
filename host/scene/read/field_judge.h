// Checks whether a field's formulas suit sphere tracing, and warns their author.
#pragma once
#include "formula/sdf.h"
#include "scene/json/value.h"

namespace sundog {

/// Surveys every formula under `root`, which was read from `value`, in its part of the interval. If an
/// expression overestimates distance, or its parameters require a lower safety than the list's, sets a safety
/// that corrects it, unless the scene sets "safety". Warns of this and of other likely mistakes
/// (JsonContext::warnings). Throws SceneError if no picture is possible.
void judge_field(SdfNode& root, const JsonValue& value, const glm::dvec3& lower, const glm::dvec3& upper);

/// Warns if the solid of a user's formula reaches the boundary of the default interval.
void judge_cut(const FormulaField& formula, const JsonValue& value, const glm::dvec3& lower,
               const glm::dvec3& upper);

}  // namespace sundog
