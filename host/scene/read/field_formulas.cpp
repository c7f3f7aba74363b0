// Reads parameters and texts, and lowers each formula once as a check.
#include "scene/read/field_formulas.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/names.h"
#include "formula/lexer.h"
#include "formula/list.h"
#include "formula/lower.h"
#include "formula/syntax.h"

namespace sundog {

void fail_formula(const JsonValue& value, const FormulaError& error) {
  const std::string at = error.line > 0 ? fmt::format("line {}, column {}: ", error.line, error.column) : "";
  if (!error.section.empty() && value.json().is_object() && value.json().contains(error.section))
    value.member(error.section, "").fail(at + error.what());
  value.fail("the formula " + at + error.what());
}

std::string read_text(JsonObject& object, std::string_view key) {
  const auto value = object.find(key);
  if (!value) return "";
  if (value->json().is_string()) return value->text();
  std::string text;
  for (const JsonValue& line : value->items("lines")) {
    const auto* written = line.json().get_ptr<const std::string*>();
    text += (written && written->empty() ? "" : line.text()) + "\n";
  }
  return text;
}

namespace {

/// Reads a parameter's value: a number, or an array of its components.
std::vector<double> read_components(const JsonValue& value, std::size_t size, const Range& range) {
  if (size == 1) return {value.number(range)};
  const auto items = value.items(fmt::format("{} numbers", size));
  if (items.size() != size) value.wanted(fmt::format("an array of {} numbers", size));
  std::vector<double> values;
  for (const JsonValue& item : items) values.push_back(item.number(range));
  return values;
}

void require_whole(const JsonValue& value, const std::vector<double>& values) {
  for (const double v : values)
    if (v != std::floor(v)) value.wanted("a whole number");
}

/// Sets a built-in formula's parameters.
void read_arguments(JsonObject& object, FormulaDefinition& d) {
  const auto given = object.find("parameters");
  if (!given) return;
  for (const auto& [name, value] : given->members("parameters")) {
    const auto found =
        std::find_if(d.parameters.begin(), d.parameters.end(), [&, key = name](const FormulaParameter& p) {
          return p.name == key || (p.old_name == key && !key.empty());
        });
    if (found == d.parameters.end()) {
      const std::vector<std::string> names = names_of(d.parameters);
      const std::string all = fmt::format("it has {}", fmt::join(names, ", "));
      value.fail(fmt::format("{} has no parameter \"{}\": {}", d.name, name,
                             did_you_mean(name, names, names.empty() ? "it has none" : all)));
    }
    found->value =
        read_components(value, found->value.size(), {.low = found->minimum, .high = found->maximum});
    if (found->whole) require_whole(value, found->value);
  }
}

std::size_t component_count(const JsonValue& value) {
  return value.json().is_array() ? value.items("numbers").size() : 1;
}

/// Reads a parameter that a user's formula declares: its value, or {value, min, max, whole}.
FormulaParameter read_declaration(const std::string& name, const JsonValue& value) {
  FormulaParameter p;
  p.name = name;
  const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  if (name.empty() || name.size() > FormulaLimits::name_length ||
      !std::all_of(name.begin(), name.end(), letter) || std::isdigit(static_cast<unsigned char>(name[0])))
    value.fail(fmt::format("a parameter's name has up to {} letters, digits and _, found \"{}\"",
                           FormulaLimits::name_length, name));
  static constexpr std::array<std::string_view, 6> taken{"z", "c", "p", "r", "i", "dr"};
  if (is_reserved_word(name) || std::find(taken.begin(), taken.end(), name) != taken.end())
    value.fail(fmt::format("\"{}\" is a reserved word; choose another name", name));
  if (!value.json().is_object()) {
    p.value = read_components(value, component_count(value), {.low = p.minimum, .high = p.maximum});
    return p;
  }
  value.object("formula_parameter", [&](JsonObject& object) {
    object.read("min", p.minimum, "max", p.maximum, "whole", p.whole);
    if (p.maximum < p.minimum) object.at("max").wanted(fmt::format("a number not below {}", p.minimum));
    const JsonValue given = object.at("value");
    p.value = read_components(given, component_count(given), {.low = p.minimum, .high = p.maximum});
    if (p.whole) require_whole(given, p.value);
  });
  return p;
}

/// Whether the texts read `t` before setting it. The parser reports the first text with an error.
bool reads_clock(std::span<const std::string> texts) {
  try {
    for (const std::string& text : texts) {
      const std::vector<Token> tokens = tokens_of(text);
      for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
        if (tokens[i].kind != Token::Kind::name || tokens[i].text != "t") continue;
        if (i == 0 || tokens[i - 1].text != ".") return tokens[i + 1].text != "=";
      }
    }
  } catch (const FormulaError&) {
  }
  return false;
}

/// Reads a user's formula.
FormulaDefinition read_definition(JsonObject& object) {
  FormulaDefinition d;
  std::string space;
  d.name = "formula";
  object.read("name", d.name, "space", space, "estimate", d.estimate, "derivative", d.derivative);
  object.read("normalize", d.normalize);
  d.quaternion = space == "quat";
  d.start = read_text(object, "start");
  d.map = read_text(object, "map");
  d.distance = read_text(object, "distance");
  if (d.map.empty() && d.distance.empty())
    object.value().fail(
        "missing key: wanted \"map\" (statements that set z) or \"distance\" (an expression)");
  d.kind = d.map.empty()        ? FormulaKind::direct
           : d.distance.empty() ? FormulaKind::escape
                                : FormulaKind::folded;
  if (d.estimate == EscapeEstimate::linear) {  // r / dr ignores the size of the set itself
    d.bailout = 1000;
    d.inside_radius = 1e9;
    d.inside_safety = 0.5;
  }
  d.smooth = d.kind == FormulaKind::direct;
  d.safety = d.kind == FormulaKind::direct          ? (d.normalize ? 0.8 : 1)
             : d.estimate == EscapeEstimate::linear ? 0.85
                                                    : 0.9;
  d.parameters = read_declarations(object, std::array{d.start, d.map, d.distance});
  return d;
}

FormulaDefinition read_listed(JsonObject& object) {
  const JsonValue name = object.at("formula");
  const FormulaDefinition* listed = find_formula(name.text());
  if (!listed) {
    if (const auto near = nearest_name(name.text(), names_of(formula_list())))
      name.fail(fmt::format("no surface \"{}\" in the list: did you mean \"{}\"?", name.text(), *near));
    name.wanted(
        "the name of a surface of the list (sundog formulas prints it; a text of your own is the \"map\" or "
        "\"distance\" of an object of \"type\": \"formula\")");
  }
  FormulaDefinition d = *listed;
  read_arguments(object, d);
  object.read("derivative", d.derivative);
  return d;
}

/// Whether a map with the running derivative should use the radial one, as built-in powers do. It must not
/// fold; without a triplex power both derivatives are equal.
bool suits_radial(const FormulaDefinition& d, const LoweredFormula& lowered) {
  return d.derivative == FormulaDerivative::automatic && d.kind == FormulaKind::escape &&
         d.estimate == EscapeEstimate::logarithmic && !lowered.jacobian && !lowered.folds;
}

/// Reads iterations, bailout and safety; checks the formula by lowering it.
FormulaLeaf read_leaf(JsonObject& object, const FormulaDefinition& d) {
  FormulaLeaf leaf{{}, d.bounds};
  leaf.field.iterations = d.iterations;
  object.read("iterations", leaf.field.iterations);
  leaf.field.bailout =
      object.number("bailout", d.bailout, {.low = d.kind == FormulaKind::escape ? 1e-3 : 0, .high = 1e9});
  leaf.field.safety = d.safety;
  object.read("safety", leaf.field.safety);
  leaf.field.steps.push_back({d, default_values(d), 1});
  try {
    const LoweredFormula lowered = lower(d, leaf.field.steps[0].values);
    if (suits_radial(d, lowered)) leaf.field.steps[0].definition.derivative = FormulaDerivative::radial;
  } catch (const FormulaError& error) {
    fail_formula(object.value(), error);
  }
  return leaf;
}

/// A sequence that contains a power escapes like the power, so it gets the power's estimate and, lest
/// escaping orbits overflow, its bailout.
double bailout_of(std::vector<FormulaStep>& steps) {
  FormulaDefinition& last = steps.back().definition;
  double bailout = last.bailout;
  if (last.kind != FormulaKind::escape) return bailout;
  for (const FormulaStep& step : steps) {
    const FormulaDefinition& d = step.definition;
    if (d.kind != FormulaKind::escape || d.estimate != EscapeEstimate::logarithmic || !find_formula(d.name))
      continue;
    last.estimate = EscapeEstimate::logarithmic;
    last.inside_radius = std::min(last.inside_radius, d.inside_radius);
    last.inside_safety = std::min(last.inside_safety, d.inside_safety);
    bailout = std::min(bailout, d.bailout);
  }
  return bailout;
}

}  // namespace

std::vector<FormulaParameter> read_declarations(JsonObject& object, std::span<const std::string> texts) {
  std::vector<FormulaParameter> all;
  if (const auto given = object.find("parameters"))
    for (const auto& [name, value] : given->members("parameters")) {
      if (all.size() == FormulaDefinition::max_parameters)
        value.fail(fmt::format("a formula may have {} parameters", FormulaDefinition::max_parameters));
      all.push_back(read_declaration(name, value));
    }
  const bool has_own = std::ranges::count(all, "t", &FormulaParameter::name) > 0;
  if (!has_own && all.size() < FormulaDefinition::max_parameters && reads_clock(texts)) {
    const JsonContext& context = object.value().context();
    all.push_back({.name = "t", .value = {context.seconds.value_or(0)}});
    if (context.plays) *context.plays = true;
  }
  return all;
}

FormulaLeaf read_single(JsonObject& object, std::string_view type) {
  return read_leaf(object, type == "formula" ? read_definition(object) : read_listed(object));
}

FormulaLeaf read_hybrid(JsonObject& object) {
  FormulaLeaf all{};
  for (const JsonValue& item : object.at("steps").items("formulas")) {
    const std::string type = item.type();
    item.object("step", [&](JsonObject& step) {
      FormulaDefinition d = type == "formula" ? read_definition(step) : read_listed(step);
      if (d.kind == FormulaKind::direct)
        item.fail(fmt::format("{} is no iteration and cannot be a step", d.name));
      if (!all.field.steps.empty() && d.quaternion != all.field.steps[0].definition.quaternion)
        item.fail("formulas of points and of quaternions cannot follow each other");
      // The radial derivative is too small near its poles, which folds would copy everywhere.
      if (d.derivative == FormulaDerivative::radial && !item.json().contains("derivative"))
        d.derivative = FormulaDerivative::running;
      int times = 1;
      step.read("times", times);
      if (all.field.steps.empty()) all.bounds = d.bounds;
      all.field.steps.push_back({d, default_values(d), times});
    });
  }
  FormulaDefinition& last = all.field.steps.back().definition;
  const double bailout = bailout_of(all.field.steps);
  all.field.iterations = last.iterations;
  all.field.safety = 0.8;
  object.read("iterations", all.field.iterations, "safety", all.field.safety);
  all.field.bailout =
      object.number("bailout", bailout, {.low = last.kind == FormulaKind::escape ? 1e-3 : 0, .high = 1e9});
  return all;
}

}  // namespace sundog
