// Writes a function for each pattern, and one that calls them by number.
#include "compile/fields/pattern_code.h"

#include <fmt/format.h>

#include "compile/fields/sdf_emit.h"
#include "formula/lower.h"

namespace sundog {
namespace {

std::string function_of(const PatternFormula& formula, std::size_t number) {
  const LoweredPattern lowered = lower_pattern(formula);
  FieldCode code;
  const Operand width = code.argument("width", FieldType::real);
  GraphWriter write(code, lowered.graph, lowered.values, "f", [&](int index) {
    if (index >= formula_input::parameter)
      return Operand::table(static_cast<std::size_t>(index - formula_input::parameter));
    return index == formula_input::iteration ? width
                                             : FieldCode::point().coordinate(index - formula_input::p);
  });
  write.write_rest();
  std::string out = fmt::format(
      "static inline REAL4 pattern_{}(REAL3 p, REAL width, __global const float* restrict q) {{\n", number);
  out += code.statements_text();
  const auto value = [&](std::size_t i) {
    return "finite_value(" + code.text(write.value(lowered.values[i])) + ")";
  };
  if (lowered.values.size() == 1)
    return out + fmt::format("    const REAL t = {};\n    return real4(t, t, t, t);\n}}\n\n", value(0));
  return out +
         fmt::format("    return real4({}, {}, {}, (REAL)(1.0f));\n}}\n\n", value(0), value(1), value(2));
}

}  // namespace

std::string pattern_code(std::span<const PatternFormula> formulas) {
  std::string functions, calls;
  for (std::size_t i = 0; i < formulas.size(); ++i) {
    functions += function_of(formulas[i], i);
    calls += fmt::format("    if (number == {}u) return pattern_{}(p, width, q);\n", i, i);
  }
  return "// Formulas of patterns, made by the host from the scene.\n"
         "#ifndef SUNDOG_GENERATED_PATTERNS_CL\n#define SUNDOG_GENERATED_PATTERNS_CL\n"
         "#include \"lib/sdf/sample.h\"\n\n"
         "static inline REAL finite_value(REAL x) {\n"
         "    return select((REAL)(0.0f), x, MASK_OF(fabs(x) < 1e30f));\n}\n\n" +
         functions +
         "static inline REAL4 pattern_formula(u32 number, REAL3 p, REAL width, __global const float* "
         "restrict q) {\n" +
         calls +
         "    const REAL zero = (REAL)(0.0f);\n    return real4(zero, zero, zero, zero);\n}\n\n#endif\n";
}

}  // namespace sundog
