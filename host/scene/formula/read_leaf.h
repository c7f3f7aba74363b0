// The leaves of a field's tree from JSON: formulas of the list, users' own, and hybrids of both.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "scene/formula/error.h"
#include "scene/formula/sdf.h"
#include "scene/json/value.h"

namespace sundog {

/// Throws the SceneError of what is wrong with a formula, at its key where it has one.
[[noreturn]] void fail_formula(const JsonValue& value, const FormulaError& error);

/// A text of the language: a string, or an array of lines.
std::string read_text(JsonObject& object, std::string_view key);

/// The "parameters" that a formula of the user's own declares. Throws SceneError.
std::vector<FormulaParameter> read_declarations(JsonObject& object);

/// A formula and the interval that it is built in unless the scene says otherwise: lower, upper.
struct FormulaLeaf {
  FormulaField field;
  std::array<double, 6> bounds;
};

/// Reads a "fractal" or "formula", which is lowered to check it. Throws SceneError.
FormulaLeaf read_single(JsonObject& object, std::string_view type);

/// Reads a "hybrid". Throws SceneError.
FormulaLeaf read_hybrid(JsonObject& object);

}  // namespace sundog
