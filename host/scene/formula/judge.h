// Whether the formulas of a field are what sphere tracing takes them for, told to who wrote them.
#pragma once
#include "scene/formula/sdf.h"
#include "scene/json/value.h"

namespace sundog {

/// Surveys every formula under `root`, which `value` was read into, in its part of the interval. An
/// expression that is no distance, or whose parameters make the list's safety too great, gets a safety that
/// makes it one, unless the scene sets "safety" itself; that, and what else will not look as it was meant, is
/// warned of (JsonContext::warnings). Throws SceneError where no picture can come of it.
void judge_field(SdfNode& root, const JsonValue& value, const glm::dvec3& lower, const glm::dvec3& upper);

/// Warns where the solid of a formula of the user's own, which has no interval but the default one, reaches
/// that one's boundary.
void judge_cut(const FormulaField& formula, const JsonValue& value, const glm::dvec3& lower,
               const glm::dvec3& upper);

}  // namespace sundog
