#include "scene/formula/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/formula/judge.h"
#include "scene/formula/list.h"
#include "scene/formula/lower.h"
#include "scene/formula/syntax.h"

namespace sundog {
namespace {

constexpr std::array<std::string_view, 11> types{"fractal",      "formula",    "hybrid", "union",
                                                 "intersection", "difference", "moved",  "repeat",
                                                 "thicken",      "shell",      "native"};
constexpr int deepest = SdfNode::max_depth;

/// The error of a formula, at its key where it has one.
[[noreturn]] void fail(const JsonValue& value, const FormulaError& error) {
  const std::string at = error.line > 0 ? fmt::format("line {}, column {}: ", error.line, error.column) : "";
  if (!error.section.empty() && value.json().is_object() && value.json().contains(error.section))
    value.member(error.section, "").fail(at + error.what());
  value.fail("the formula " + at + error.what());
}

/// A parameter's value: a number, or an array of as many as it has components.
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

/// Sets the parameters of a listed formula.
void read_arguments(JsonObject& object, FormulaDefinition& d) {
  const auto given = object.find("parameters");
  if (!given) return;
  for (const auto& [name, value] : given->members("parameters")) {
    const auto found = std::find_if(d.parameters.begin(), d.parameters.end(),
                                    [&, key = name](const FormulaParameter& p) { return p.name == key; });
    if (found == d.parameters.end()) {
      std::string known;
      for (const FormulaParameter& p : d.parameters) known += (known.empty() ? "" : ", ") + p.name;
      value.fail(
          fmt::format("{} has no parameter \"{}\"; it has {}", d.name, name, known.empty() ? "none" : known));
    }
    found->value =
        read_components(value, found->value.size(), {.low = found->minimum, .high = found->maximum});
    if (found->whole) require_whole(value, found->value);
  }
}

std::size_t component_count(const JsonValue& value) {
  if (!value.json().is_array()) return 1;
  if (value.json().size() != 3 && value.json().size() != 4) value.wanted("a number, or an array of 3 or 4");
  return value.json().size();
}

/// A parameter that a user's formula declares: its value, or {value, min, max, whole}.
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
    const Range limits{.low = -1e6, .high = 1e6};
    p.minimum = object.number("min", p.minimum, limits);
    p.maximum = object.number("max", p.maximum, {.low = p.minimum, .high = 1e6});
    const JsonValue given = object.at("value", "a number or an array of numbers");
    p.value = read_components(given, component_count(given), {.low = p.minimum, .high = p.maximum});
    p.whole = object.boolean("whole", false);
    if (p.whole) require_whole(given, p.value);
  });
  return p;
}

/// A text of the language: a string, or an array of lines.
std::string read_text(JsonObject& object, std::string_view key) {
  const auto value = object.find(key);
  if (!value) return "";
  if (value->json().is_string()) return value->text();
  std::string text;
  for (const JsonValue& line : value->items("lines")) text += line.text() + "\n";
  return text;
}

FormulaDerivative read_derivative(JsonObject& object, FormulaDerivative fallback) {
  static constexpr std::array<std::string_view, 4> names{"automatic", "running", "radial", "jacobian"};
  const std::string name = object.choice("derivative", names[static_cast<std::size_t>(fallback)], names);
  return static_cast<FormulaDerivative>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// A formula of the user's own.
FormulaDefinition read_definition(JsonObject& object) {
  FormulaDefinition d;
  d.name = object.text("name", "formula");
  static constexpr std::array<std::string_view, 2> spaces{"vec3", "quat"}, estimates{"logarithmic", "linear"};
  d.quaternion = object.choice("space", "vec3", spaces) == "quat";
  d.start = read_text(object, "start");
  d.map = read_text(object, "map");
  d.distance = read_text(object, "distance");
  if (d.map.empty() && d.distance.empty())
    object.value().fail(
        "missing key: wanted \"map\" (statements that set z) or \"distance\" (an expression)");
  d.kind = d.map.empty()        ? FormulaKind::direct
           : d.distance.empty() ? FormulaKind::escape
                                : FormulaKind::folded;
  d.estimate = object.choice("estimate", "logarithmic", estimates) == "linear" ? EscapeEstimate::linear
                                                                               : EscapeEstimate::logarithmic;
  if (d.estimate == EscapeEstimate::linear) {  // r / dr leaves out how large the set itself is
    d.bailout = 1000;
    d.inside_radius = 1e9;
    d.inside_safety = 0.5;
  }
  d.derivative = read_derivative(object, d.derivative);
  d.normalize = object.boolean("normalize", false);
  d.smooth = d.kind == FormulaKind::direct;
  d.safety = d.kind == FormulaKind::direct          ? (d.normalize ? 0.8 : 1)
             : d.estimate == EscapeEstimate::linear ? 0.85
                                                    : 0.9;
  if (const auto given = object.find("parameters"))
    for (const auto& [name, value] : given->members("parameters")) {
      if (d.parameters.size() == FormulaDefinition::max_parameters)
        value.fail(fmt::format("a formula may have {} parameters", FormulaDefinition::max_parameters));
      d.parameters.push_back(read_declaration(name, value));
    }
  return d;
}

FormulaDefinition read_listed(JsonObject& object) {
  const JsonValue name =
      object.at("formula", "the name of a surface of the list (sundog formulas prints it)");
  const FormulaDefinition* listed = find_formula(name.text());
  if (!listed) {
    std::vector<std::string> names;
    for (const FormulaDefinition& d : formula_list()) names.push_back(d.name);
    const auto nearest = nearest_name(name.text(), names);
    name.fail(fmt::format("no surface \"{}\" in the list; {}", name.text(),
                          nearest ? fmt::format("is \"{}\" meant?", *nearest) : "sundog formulas prints it"));
  }
  FormulaDefinition d = *listed;
  read_arguments(object, d);
  d.derivative = read_derivative(object, d.derivative);
  return d;
}

struct Leaf {
  FormulaField field;
  std::array<double, 6> bounds;
};

/// The keys that say how far orbits are followed; checks the formula by lowering it.
Leaf read_leaf(JsonObject& object, FormulaDefinition d) {
  Leaf leaf{{}, d.bounds};
  leaf.field.iterations = object.integer("iterations", d.iterations, 1, FormulaDefinition::max_iterations);
  leaf.field.bailout =
      object.number("bailout", d.bailout, {.low = d.kind == FormulaKind::escape ? 1e-3 : 0, .high = 1e9});
  leaf.field.safety = object.number("safety", d.safety, {.low = 1e-3, .high = 1});
  leaf.field.steps.push_back({d, default_values(d), 1});
  try {
    lower(d, leaf.field.steps[0].values);
  } catch (const FormulaError& error) {
    fail(object.value(), error);
  }
  return leaf;
}

Leaf read_single(JsonObject& object, std::string_view type) {
  return read_leaf(object, type == "formula" ? read_definition(object) : read_listed(object));
}

/// A sequence with a power in it escapes as the power does: by its estimate and, so that no power of what is
/// escaping overflows, within its bailout.
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

Leaf read_hybrid(JsonObject& object) {
  const JsonValue list = object.at("steps", "an array of formulas");
  Leaf all{};
  for (const JsonValue& item : list.items("formulas")) {
    if (all.field.steps.size() == 8) item.fail("a hybrid may have 8 formulas");
    static constexpr std::array<std::string_view, 2> kinds{"fractal", "formula"};
    const std::string type = item.member("type", list_names(kinds)).choice(kinds);
    item.object(type + "_step", [&](JsonObject& step) {
      step.at("type", "");
      FormulaDefinition d = type == "formula" ? read_definition(step) : read_listed(step);
      if (d.kind == FormulaKind::direct)
        item.fail(fmt::format("{} is no iteration and cannot be a step", d.name));
      if (!all.field.steps.empty() && d.quaternion != all.field.steps[0].definition.quaternion)
        item.fail("formulas of points and of quaternions cannot follow each other");
      // Near its poles the radial derivative is too small; folds would bring the poles everywhere.
      if (d.derivative == FormulaDerivative::radial && !item.json().contains("derivative"))
        d.derivative = FormulaDerivative::running;
      const int times = step.integer("times", 1, 1, 100);
      if (all.field.steps.empty()) all.bounds = d.bounds;
      all.field.steps.push_back({d, default_values(d), times});
    });
  }
  if (all.field.steps.empty()) list.wanted("an array of one formula or more");
  FormulaDefinition& last = all.field.steps.back().definition;
  const double bailout = bailout_of(all.field.steps);
  all.field.iterations = object.integer("iterations", last.iterations, 1, FormulaDefinition::max_iterations);
  all.field.bailout =
      object.number("bailout", bailout, {.low = last.kind == FormulaKind::escape ? 1e-3 : 0, .high = 1e9});
  all.field.safety = object.number("safety", 0.8, {.low = 1e-3, .high = 1});
  return all;
}

SdfNode read_node(JsonObject& object, std::string_view type, std::array<double, 6>* bounds, int depth);

SdfNode read_child(const JsonValue& value, int depth, std::array<double, 6>* bounds = nullptr) {
  if (depth > deepest) value.fail(fmt::format("fields nested deeper than {} levels", deepest));
  const std::string type = value.member("type", list_names(types)).choice(types);
  return value.object(type + "_field", [&](JsonObject& object) {
    object.at("type", "");
    return read_node(object, type, bounds, depth);
  });
}

SdfNode read_joint(JsonObject& object, std::string_view type, int depth) {
  SdfNode node;
  node.kind = type == "union"          ? SdfNode::Kind::unite
              : type == "intersection" ? SdfNode::Kind::intersect
                                       : SdfNode::Kind::subtract;
  const JsonValue list = object.at("fields", "an array of fields");
  for (const JsonValue& item : list.items("fields")) node.children.push_back(read_child(item, depth + 1));
  if (node.children.size() < 2) list.wanted("an array of two fields or more");
  node.smooth = object.number("smooth", 0, at_least_0);
  return node;
}

SdfNode read_moved(JsonObject& object) {
  SdfNode node;
  node.kind = SdfNode::Kind::transform;
  node.offset = object.vec3("translate", glm::dvec3(0));
  node.scale = object.number("scale", 1, {.low = 1e-6, .high = 1e6});
  if (const auto rotate = object.find("rotate"))
    rotate->object("rotate", [&](JsonObject& r) {
      const glm::dvec3 axis = r.at("axis", "a direction [x, y, z]").direction();
      node.rotation = glm::dmat3(
          glm::rotate(glm::dmat4(1), glm::radians(r.at("degrees", "an angle in degrees").number()), axis));
    });
  return node;
}

SdfNode read_native(JsonObject& object) {
  if (!object.value().context().native_code)
    object.value().fail(
        "this field is OpenCL C, which the driver would run as it stands; if you trust the file, allow it "
        "with "
        "--allow-native-code");
  SdfNode node;
  node.kind = SdfNode::Kind::native;
  node.code = read_text(object, "code");
  if (node.code.empty()) object.at("code", "the body of a function of REAL3 p that returns REAL");
  return node;
}

SdfNode read_node(JsonObject& object, std::string_view type, std::array<double, 6>* bounds, int depth) {
  SdfNode node;
  if (type == "fractal" || type == "formula" || type == "hybrid") {
    const Leaf leaf = type == "hybrid" ? read_hybrid(object) : read_single(object, type);
    node.formula = leaf.field;
    if (bounds) *bounds = leaf.bounds;
    return node;
  }
  if (type == "union" || type == "intersection" || type == "difference")
    return read_joint(object, type, depth);
  if (type == "native") return read_native(object);
  if (type == "moved") {
    node = read_moved(object);
  } else if (type == "repeat") {
    node.kind = SdfNode::Kind::repeat;
    node.period = object.at("period", "an array of 3 numbers").vec3(at_least_0);
    node.count = object.vec3("count", glm::dvec3(0), at_least_0);
  } else {
    node.kind = type == "thicken" ? SdfNode::Kind::thicken : SdfNode::Kind::shell;
    node.amount = object.at("amount", "a length").number(type == "shell" ? above_0 : any_number);
  }
  node.children.push_back(read_child(object.at("field", "a field"), depth + 1));
  return node;
}

SdfColoring read_coloring(const JsonValue& value) {
  return value.object("coloring", [](JsonObject& object) {
    static constexpr std::array<std::string_view, 5> names{"point", "plane", "axis", "iterations", "radius"};
    SdfColoring coloring;
    const std::string by = object.choice("by", "point", names);
    coloring.by = static_cast<SdfColorBy>(1 + (std::find(names.begin(), names.end(), by) - names.begin()));
    const JsonValue palette = object.at("palette", "an array of colours");
    for (const JsonValue& stop : palette.items("colours")) coloring.palette.push_back(stop.color());
    if (coloring.palette.empty() || coloring.palette.size() > 64) palette.wanted("1 to 64 colours");
    coloring.scale = object.number("scale", 1);
    coloring.offset = object.number("offset", 0);
    return coloring;
  });
}

void read_interval(JsonObject& object, SdfDescription& field, bool required) {
  const auto interval =
      required ? object.at("interval", "an object with \"min\" and \"max\": where the field is built")
               : object.find("interval");
  if (!interval) return;
  interval->object("interval", [&](JsonObject& o) {
    field.lower = o.at("min", "the corner beside \"max\"").vec3({.low = -1e6, .high = 1e6});
    field.upper = o.at("max", "the corner beside \"min\"").vec3({.low = -1e6, .high = 1e6});
  });
  if (!glm::all(glm::lessThan(field.lower, field.upper)))
    interval->fail("wanted each of \"min\" below its part of \"max\"");
}

/// What the field does to light besides stopping it; `size` is half its interval's diagonal.
void read_light(JsonObject& object, SdfDescription& field, double size) {
  field.occlusion = object.number("occlusion", 0, {.low = 0, .high = size});
  field.soft_shadow = object.number("soft_shadow", 0, {.low = 0, .high = 1e4});
  if (const auto glow = object.find("glow"))
    glow->object("glow", [&](JsonObject& o) {
      field.glow = o.at("color", "a colour [r, g, b]").color();
      field.glow_width = o.number("width", 0.05 * size, {.low = 0, .high = size, .low_open = true});
    });
}

double least_safety(const SdfNode& node) {
  double least = node.kind == SdfNode::Kind::formula ? node.formula.safety : 1;
  for (const SdfNode& child : node.children) least = std::min(least, least_safety(child));
  return least;
}

/// What a field has besides its tree: where it is built, how closely it is followed, what it looks like.
/// `root`: what its tree was read from.
void read_whole(JsonObject& object, SdfDescription& field, const JsonValue& root,
                const std::array<double, 6>& bounds) {
  const bool is_leaf = field.root.kind == SdfNode::Kind::formula;
  field.lower = {bounds[0], bounds[1], bounds[2]};
  field.upper = {bounds[3], bounds[4], bounds[5]};
  read_interval(object, field, !is_leaf);
  if (const auto ball = object.find("ball"))
    field.sphere = ball->object("ball", [](JsonObject& o) {
      return glm::dvec4(o.vec3("center", glm::dvec3(0)), o.at("radius", "a length").number(above_0));
    });
  const double size = glm::length(field.upper - field.lower) / 2;
  if (const auto detail = object.find("detail")) field.detail = detail->number({.low = 0.01, .high = 16});
  field.least = object.number("least_threshold", 3e-5 * size, {.low = 1e-7 * size, .high = size});
  field.greatest = object.number("greatest_threshold", std::max(0.03 * size, field.least),
                                 {.low = field.least, .high = size});
  const bool has_limit = object.has("step_limit");
  field.step_limit = object.integer("step_limit", field.step_limit, 16, 65536);
  if (const auto coloring = object.find("coloring")) field.coloring = read_coloring(*coloring);
  read_light(object, field, size);
  try {
    if (root.context().measures) judge_field(field.root, root, field.lower, field.upper);
  } catch (const FormulaError& error) {
    fail(root, error);
  }
  if (!has_limit)  // shorter steps, more of them
    field.step_limit = static_cast<int>(std::clamp(128 / least_safety(field.root), 512.0, 8192.0));
}

}  // namespace

Names field_types() { return types; }

SdfDescription read_field(JsonObject& object, std::string_view type) {
  SdfDescription field;
  field.name = type;
  std::array<double, 6> bounds{};
  field.root = read_node(object, type, &bounds, 1);
  read_whole(object, field, object.value(), bounds);
  return field;
}

SdfDescription read_named_field(const JsonValue& value, std::string name) {
  SdfDescription field;
  field.name = std::move(name);
  value.object("field_entry", [&](JsonObject& object) {
    std::array<double, 6> bounds{};
    const JsonValue root = object.at("field", "a field");
    field.root = read_child(root, 1, &bounds);
    read_whole(object, field, root, bounds);
  });
  return field;
}

}  // namespace sundog
