// The code of a formula: what it computes at each point, and the table of its numbers.
#include "compile/fields/sdf_leaf.h"

#include <algorithm>
#include <cmath>

#include "catch.h"

using namespace sundog;

namespace {

/// A turned and scaled plane that is folded again and again.
FormulaField turned(double degrees, double scale) {
  FormulaDefinition d;
  d.kind = FormulaKind::folded;
  d.parameters = {{.name = "turn", .value = {degrees}}, {.name = "scale", .value = {scale}}};
  d.map = "z = scale * rotate(abs(z), vec3(0, 0, 1), turn * pi / 180) - (scale - 1)";
  d.distance = "z.x * cos(turn)";
  FormulaField field;
  field.steps = {{d, {degrees, scale}, 1}};
  field.iterations = 3;
  return field;
}

}  // namespace

TEST_CASE("numbers that follow from a formula's parameters are computed once, not at each point") {
  const LeafCode code = leaf_code(turned(30, 4.5)), other = leaf_code(turned(75, 2));
  for (std::size_t i = 0; i < code.functions.size(); ++i) {
    CHECK_THAT(code.functions[i]->text(), !ContainsSubstring("sin(") && !ContainsSubstring("cos("));
    CHECK(code.functions[i]->text() == other.functions[i]->text());
  }
  const auto has = [](const LeafCode& c, double value) {
    return std::ranges::count_if(c.parameters, [&](double v) { return std::abs(v - value) < 1e-12; }) > 0;
  };
  CHECK(has(code, std::cos(30.0)));
  CHECK(has(code, std::sqrt(0.75)));  // cos 30
  CHECK(has(code, 3.5));              // scale - 1
  CHECK(has(other, std::cos(75.0)));
  CHECK(code.parameters.size() == other.parameters.size());
}

TEST_CASE("numbers of a formula's parameters that no float holds end at the greatest") {
  FormulaField field = turned(30, 3);
  field.steps[0].definition.distance = "z.x * exp(scale * 100)";
  for (const double value : leaf_code(field).parameters) CHECK(std::isfinite(static_cast<float>(value)));
}
