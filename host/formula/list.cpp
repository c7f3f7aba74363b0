// Joins the three parts of the list (list_parts.h) and prints it for `sundog formulas`.
#include "formula/list.h"

#include <fmt/format.h>

#include <sstream>

#include "formula/functions.h"
#include "formula/list_parts.h"
#include "formula/syntax.h"

namespace sundog {
namespace {

std::string values_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:g}", text.empty() ? "" : ", ", value);
  return values.size() > 1 ? "[" + text + "]" : text;
}

std::string section_text(const char* name, const std::string& section) {
  std::string text, line;
  for (std::istringstream lines(section); std::getline(lines, line);)
    text += fmt::format("    {:9} {}\n", text.empty() ? std::string(name) + ":" : "", line);
  return text;
}

std::string bound_text(const FormulaDefinition& d) {
  if (d.exceptions > 0)
    return fmt::format("    bound: the estimate is too long at most in {:g} % of the interval\n",
                       100 * d.exceptions);
  return d.safety < 1 ? fmt::format("    bound: the estimate times {:g}\n", d.safety)
                      : "    bound: the estimate\n";
}

std::string entry_text(const FormulaDefinition& d) {
  std::string text = fmt::format("{}\n    {}\n    source: {}\n", d.name, d.title, d.source);
  text += section_text("start", d.start) + section_text("map", d.map) + section_text("distance", d.distance);
  if (d.kind != FormulaKind::direct)
    text += fmt::format("    iterations {}, bailout {:g}\n", d.iterations, d.bailout);
  text += fmt::format("    interval x {:g}..{:g}, y {:g}..{:g}, z {:g}..{:g}\n", d.bounds[0], d.bounds[3],
                      d.bounds[1], d.bounds[4], d.bounds[2], d.bounds[5]);
  text += bound_text(d);
  for (const FormulaParameter& p : d.parameters)
    text += fmt::format("    {} = {}  ({:g}..{:g}{}) {}\n", p.name, values_text(p.value), p.minimum,
                        p.maximum, p.whole ? ", whole" : "", p.meaning);
  return text;
}

}  // namespace

const std::vector<FormulaDefinition>& formula_list() {
  static const std::vector<FormulaDefinition> list = [] {
    std::vector<FormulaDefinition> all;
    for (const auto& part : {escape_formulas(), folded_formulas(), solid_formulas()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return list;
}

const FormulaDefinition* find_formula(const std::string& name) {
  for (const FormulaDefinition& d : formula_list())
    if (d.name == name || (d.old_name == name && !name.empty())) return &d;
  return nullptr;
}

const std::vector<FieldOperation>& field_operations() {
  static const std::vector<FieldOperation> list{
      {"hybrid", "steps, iterations, bailout, safety", "formulas applied in turn, each \"times\" in a row"},
      {"union", "fields, smooth", "what lies in any; smooth: flowing together over that length"},
      {"intersection", "fields, smooth", "what lies in all"},
      {"difference", "fields, smooth", "the first without the others"},
      {"moved", "field, translate, rotate, scale", "the field elsewhere"},
      {"repeat", "field, period, count", "the field in every cell, or in count cells to each side"},
      {"thicken", "field, amount", "its surface moved outwards"},
      {"shell", "field, amount", "its surface as a wall"},
  };
  return list;
}

std::string formula_list_text() {
  std::string text;
  for (const FormulaDefinition& d : formula_list()) text += entry_text(d) + "\n";
  text += fmt::format(
      "formula\n    Your own: \"start\" and \"map\" (statements), or \"distance\" (an expression). A map "
      "sets z; it may read c, p, r = |z|, i, pi\n    and its parameters. At most {} characters a text, {} "
      "iterations, {} parameters.\n\n",
      FormulaLimits::characters, FormulaDefinition::max_iterations, FormulaDefinition::max_parameters);
  text += "operations on fields\n";
  for (const FieldOperation& o : field_operations())
    text += fmt::format("    {:13} {:34} {}\n", o.type, o.keys, o.meaning);
  text +=
      "\nfunctions of the language\n    operators + - * / ^ < <= > >= == != && || ! ?:, components v.x, "
      "v.zxy\n";
  for (const FunctionHelp& f : function_help()) text += fmt::format("    {:24} {}\n", f.call, f.meaning);
  return text;
}

}  // namespace sundog
