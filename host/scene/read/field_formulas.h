// Reads the leaves of a field's tree: built-in formulas, users' formulas, and hybrids of both.
#pragma once
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formula/error.h"
#include "formula/sdf.h"
#include "scene/json/value.h"

namespace sundog {

/// Throws a formula's error as SceneError, at the error's key if the formula has it.
[[noreturn]] void fail_formula(const JsonValue& value, const FormulaError& error);

/// Reads formula text: a string or an array of lines.
std::string read_text(JsonObject& object, std::string_view key);

/// Reads the "parameters" that a user's formula declares, and adds the clock `t` if a text reads it before
/// setting it. Throws SceneError.
std::vector<FormulaParameter> read_declarations(JsonObject& object, std::span<const std::string> texts);

/// A formula and its default interval: lower corner, upper corner.
struct FormulaLeaf {
  FormulaField field;
  std::array<double, 6> bounds;
};

/// Reads a "fractal" or "formula", and lowers it as a check. Throws SceneError.
FormulaLeaf read_single(JsonObject& object, std::string_view type);

/// Reads a "hybrid". Throws SceneError.
FormulaLeaf read_hybrid(JsonObject& object);

}  // namespace sundog
