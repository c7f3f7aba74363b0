// `sundog formulas`: prints a list, or JSON: "formulas" with each surface's source, text, limits, interval
// and parameters, "operations" that combine fields, and "functions" of the language.
#include "app/commands/formulas_command.h"
#include "base/arguments.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/options/command.h"
#include "base/json_text.h"
#include "formula/functions.h"
#include "formula/list.h"

namespace sundog {
namespace {

using nlohmann::ordered_json;

const char* kind_name(FormulaKind kind) {
  return kind == FormulaKind::escape ? "escape" : kind == FormulaKind::folded ? "folded" : "direct";
}

ordered_json parameter_json(const FormulaParameter& p) {
  ordered_json row = {{"name", p.name}};
  row["default"] = p.value.size() == 1 ? ordered_json(p.value[0]) : ordered_json(p.value);
  row.update({{"min", p.minimum}, {"max", p.maximum}, {"whole", p.whole}, {"meaning", p.meaning}});
  return row;
}

ordered_json formula_json(const FormulaDefinition& d) {
  ordered_json row = {{"name", d.name},
                      {"title", d.title},
                      {"source", d.source},
                      {"kind", kind_name(d.kind)},
                      {"space", d.quaternion ? "quat" : "vec3"}};
  const std::pair<const char*, const std::string&> texts[] = {
      {"start", d.start}, {"map", d.map}, {"distance", d.distance}};
  for (const auto& [key, text] : texts)
    if (!text.empty()) row[key] = text;
  if (d.kind != FormulaKind::direct) row.update({{"iterations", d.iterations}, {"bailout", d.bailout}});
  const auto& b = d.bounds;
  row["interval"] = {{"min", {b[0], b[1], b[2]}}, {"max", {b[3], b[4], b[5]}}};
  row["safety"] = d.safety;
  row["exceptions"] = d.exceptions;
  row["parameters"] = ordered_json::array();
  for (const FormulaParameter& p : d.parameters) row["parameters"].push_back(parameter_json(p));
  return row;
}

}  // namespace

std::string formulas_json() {
  ordered_json all = {{"schema", 1},
                      {"formulas", ordered_json::array()},
                      {"operations", ordered_json::array()},
                      {"functions", ordered_json::array()}};
  for (const FormulaDefinition& d : formula_list()) all["formulas"].push_back(formula_json(d));
  for (const FieldOperation& o : field_operations())
    all["operations"].push_back({{"type", o.type}, {"keys", o.keys}, {"meaning", o.meaning}});
  for (const FunctionHelp& f : function_help())
    all["functions"].push_back({{"call", f.call}, {"meaning", f.meaning}});
  return json_text(all, 2) + "\n";
}

void add_formulas(Arguments& root, Command& chosen) {
  Arguments* app =
      root.add_subcommand("formulas", "List the fractals and solids that are marched, with their parameters");
  const auto json = std::make_shared<bool>(false);
  app->add_flag("--json", *json, "as JSON");
  app->callback([json, &chosen] {
    const auto print = [json] {
      fmt::print("{}", *json ? formulas_json() : formula_list_text());
      return static_cast<int>(exit_done);
    };
    chosen = {.run = print, .only_prints = true};
  });
}

}  // namespace sundog
