// Lowers a formula's parts (start, map, finish) to sections of code with tangents. See lower.h.
#include "formula/lower.h"

#include <functional>
#include <stdexcept>

#include "formula/error.h"
#include "formula/functions.h"
#include "formula/lowering.h"

namespace sundog {
namespace {

namespace in = formula_input;

Value point_input(Graph& g) {
  Value p;
  p.type = ValueType::vec3;
  for (int i = 0; i < 3; ++i) p.part[static_cast<std::size_t>(i)] = g.input(in::p + i);
  p.varies = true;
  p.slope = g.constant(1);
  return p;
}

Value number_input(Graph& g, int index) {
  Value p;
  p.part[0] = g.input(index);
  return p;
}

Value state_input(Graph& g, int first, int size) {
  Value z;
  z.type = size == 4 ? ValueType::quat : ValueType::vec3;
  for (int i = 0; i < size; ++i) z.part[static_cast<std::size_t>(i)] = g.input(first + i);
  z.varies = true;
  return z;
}

std::vector<NodeId> parts(const Value& value) {
  return {value.part.begin(), value.part.begin() + value.size()};
}

NodeId zero_for_none(Graph& g, NodeId id) { return id == no_node ? g.constant(0) : id; }

/// Tangents of `outputs` along x, y and z; constants if possible.
std::vector<std::array<NodeId, 3>> tangents(Graph& g, const std::vector<NodeId>& outputs,
                                            const std::function<NodeId(int input, int axis)>& of) {
  std::vector<std::array<NodeId, 3>> result(outputs.size());
  for (int axis = 0; axis < 3; ++axis) {
    const auto column = differentiate(g, outputs, [&](int input) { return of(input, axis); });
    for (std::size_t i = 0; i < outputs.size(); ++i)
      result[i][static_cast<std::size_t>(axis)] = zero_for_none(g, column[i]);
  }
  return result;
}

NodeId slope_of(Graph& g, const Value& value) {
  return !value.varies ? g.constant(0) : value.tight ? value.slope : no_node;
}

void lower_start(LoweredFormula& out, const FormulaDefinition& d, const std::vector<double>& values) {
  Section& s = out.start;
  Lowering low(s.graph, d, values);
  const Value p = point_input(s.graph);
  low.define("p", p);
  Value z = p;
  if (d.quaternion) z = call_function(low.v, "quat", {p, low.v.number(0)});
  low.declare("z", z);
  low.declare("c", z);
  low.run(parse_statements(d.start));
  s.z = parts(low.variable("z"));
  s.c = parts(low.was_set("z") && !low.was_set("c") ? low.variable("z") : low.variable("c"));
  s.derivative = slope_of(s.graph, low.variable("z"));
  s.c_slope =
      slope_of(s.graph, low.was_set("z") && !low.was_set("c") ? low.variable("z") : low.variable("c"));
  const auto identity = [&](int input, int axis) {
    return input == in::p + axis ? s.graph.constant(1) : no_node;
  };
  s.guards = low.v.guards;
  s.z_tangents = tangents(s.graph, s.z, identity);
  s.c_tangents = tangents(s.graph, s.c, identity);
}

/// c as seen by the map: with the start's slope and tangents if they are constant.
Value c_input(Graph& g, const LoweredFormula& f) {
  Value c = state_input(g, in::c, f.size);
  const Graph& start = f.start.graph;
  if (f.start.c_slope == no_node)
    c.tight = false;
  else if (start.is_constant(f.start.c_slope)) {
    c.slope = g.constant(start[f.start.c_slope].value);
    c.varies = start[f.start.c_slope].value != 0;
  } else
    c.slope = g.input(in::c_slope);
  return c;
}

NodeId tangent_of_input(Graph& g, const LoweredFormula& f, int input, int axis) {
  if (input >= in::p && input < in::p + 3) return input == in::p + axis ? g.constant(1) : no_node;
  if (input >= in::z && input < in::z + f.size) return g.input(in::tangent_of_z(input - in::z, axis));
  if (input >= in::c && input < in::c + f.size) {
    const int i = input - in::c;
    const NodeId known = f.start.c_tangents[static_cast<std::size_t>(i)][static_cast<std::size_t>(axis)];
    if (!f.start.graph.is_constant(known)) return g.input(in::tangent_of_c(i, axis));
    const double value = f.start.graph[known].value;
    return value == 0 ? no_node : g.constant(value);
  }
  if (input == in::square) {  // 2 z . z'
    NodeId sum = no_node;
    for (int i = 0; i < f.size; ++i) {
      const NodeId term = g.mul(g.input(in::z + i), g.input(in::tangent_of_z(i, axis)));
      sum = sum == no_node ? term : g.add(sum, term);
    }
    return g.scaled(sum, 2);
  }
  return no_node;
}

void lower_map(LoweredFormula& out, const FormulaDefinition& d, const std::vector<double>& values) {
  Section& s = out.map;
  Graph& g = s.graph;
  Lowering low(g, d, values);
  Value z = state_input(g, in::z, out.size);
  z.depends_z = true;
  z.slope = g.input(in::derivative);
  z.tight = out.start.derivative != no_node;
  g.mark_not_negative(g.input(in::square));
  g.alias(low.v.square_length(z).x(), g.input(in::square));
  low.define("p", point_input(g));
  low.define("c", c_input(g, out));
  low.define("r", low.v.length(z));
  low.define("i", number_input(g, in::iteration));
  low.declare("z", z);
  const auto statements = parse_statements(d.map);
  low.run(statements);
  if (!low.was_set("z")) throw FormulaError(1, 1, "a map must set z, as in \"z = z^8 + c\"");
  out.folds = low.v.folds;
  s.z = parts(low.variable("z"));
  s.derivative = slope_of(g, low.variable("z"));
  s.guards = low.v.guards;
  s.z_tangents = tangents(g, s.z, [&](int input, int axis) { return tangent_of_input(g, out, input, axis); });
}

void lower_finish(LoweredFormula& out, const FormulaDefinition& d, const std::vector<double>& values) {
  Section& s = out.finish;
  Graph& g = s.graph;
  Lowering low(g, d, values);
  low.define("p", point_input(g));
  if (d.kind != FormulaKind::direct) {
    Value z = state_input(g, in::z, out.size);
    z.tight = false;  // the running derivative is not needed
    low.define("z", z);
    low.define("c", c_input(g, out));
    low.define("r", low.v.length(z));
  }
  const FormulaBody body = parse_body(d.distance);
  const Expression& expression = body.result;
  low.run(body.statements);
  const Value distance = low.value_of(expression);
  if (distance.type != ValueType::scalar)
    throw FormulaError(expression.place.line, expression.place.column,
                       "a distance is a number, found a " + name_of(distance.type));
  s.distance = distance.x();
  s.guards = low.v.guards;
  const auto columns =
      tangents(g, {s.distance}, [&](int input, int axis) { return tangent_of_input(g, out, input, axis); });
  s.gradient = columns[0];
  if (d.kind != FormulaKind::direct || !d.normalize) return;
  NodeId square = g.constant(1e-12);
  for (const NodeId part : s.gradient) square = g.add(square, g.mul(part, part));
  s.distance = g.apply(Op::divide, s.distance, g.sqrt(square));
}

}  // namespace

LoweredPattern lower_pattern(const PatternFormula& formula) {
  FormulaDefinition definition;
  definition.kind = FormulaKind::direct;
  definition.parameters = formula.parameters;
  const std::vector<double> values = default_values(definition);
  LoweredPattern out;
  Lowering low(out.graph, definition, values);
  Value p, width;
  p.type = ValueType::vec3;
  for (int i = 0; i < 3; ++i) p.part[static_cast<std::size_t>(i)] = out.graph.input(in::p + i);
  width.part[0] = out.graph.input(in::iteration);
  // No derivative is needed.
  p.varies = width.varies = true;
  p.tight = width.tight = false;
  low.define("p", p);
  low.define("width", width);
  const FormulaBody body = parse_body(formula.text);
  low.run(body.statements);
  const Value value = low.value_of(body.result);
  if (value.type != ValueType::scalar && value.type != ValueType::vec3)
    throw FormulaError(body.result.place.line, body.result.place.column,
                       "a pattern is a number or a vec3, found a " + name_of(value.type));
  out.values.assign(value.part.begin(), value.part.begin() + value.size());
  return out;
}

std::vector<double> default_values(const FormulaDefinition& definition) {
  std::vector<double> values;
  for (const FormulaParameter& p : definition.parameters)
    values.insert(values.end(), p.value.begin(), p.value.end());
  return values;
}

LoweredFormula lower(const FormulaDefinition& definition, const std::vector<double>& values,
                     const Section* start) {
  LoweredFormula out;
  out.size = definition.quaternion ? 4 : 3;
  const auto section = [&](const char* name, auto lower_section) {
    try {
      lower_section(out, definition, values);
    } catch (FormulaError& error) {
      error.section = name;
      throw;
    } catch (const std::logic_error& error) {  // thrown while differentiating
      FormulaError placed(1, 1, error.what());
      placed.section = name;
      throw placed;
    }
  };
  if (definition.kind == FormulaKind::direct) {
    section("distance", lower_finish);
    return out;
  }
  if (start)
    out.start = *start;
  else
    section("start", lower_start);
  section("map", lower_map);
  if (definition.kind == FormulaKind::folded) section("distance", lower_finish);
  const bool running = out.map.derivative != no_node && out.start.derivative != no_node;
  const bool wanted = definition.derivative == FormulaDerivative::running ||
                      definition.derivative == FormulaDerivative::radial;
  if (wanted && !running)
    throw FormulaError(0, 0, "the map has no tight running derivative; use \"derivative\": \"jacobian\"");
  out.jacobian = definition.derivative == FormulaDerivative::jacobian || !running;
  return out;
}

}  // namespace sundog
