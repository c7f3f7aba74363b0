#include "scene/formula/lower.h"

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "scene/formula/functions.h"
#include "scene/formula/syntax.h"
#include "scene/formula/value.h"

namespace sundog {
namespace {

namespace in = formula_input;

/// Walks syntax trees and gives them their values in one graph.
class Lowering {
 public:
  Lowering(Graph& graph, const FormulaDefinition& definition, const std::vector<double>& values)
      : v(graph), g(graph), parameter_values_(values) {
    v.radial = definition.derivative == FormulaDerivative::radial;
    int slot = 0;
    for (const FormulaParameter& parameter : definition.parameters) {
      Value p;
      p.type = parameter.value.size() == 1   ? ValueType::scalar
               : parameter.value.size() == 3 ? ValueType::vec3
                                             : ValueType::quat;
      for (std::size_t i = 0; i < parameter.value.size(); ++i) p.part[i] = g.input(in::parameter + slot++);
      define(parameter.name, p);
    }
    define("pi", v.number(std::numbers::pi));
  }

  /// A name that statements may read but not set.
  void define(const std::string& name, const Value& value) { fixed_[name] = value; }
  /// A name that statements may set to another value of the same type.
  void declare(const std::string& name, const Value& value) { variables_[name] = value; }
  const Value& variable(const std::string& name) const { return variables_.at(name); }
  bool was_set(const std::string& name) const { return set_.contains(name); }

  void run(const std::vector<Statement>& statements) {
    for (const Statement& s : statements) assign(s);
  }

  Value value_of(const Expression& e) {
    try {
      const Value value = lower(e);
      for (DomainGuard& guard : v.guards)
        if (guard.line == 0) {
          guard.line = e.place.line;
          guard.column = e.place.column;
          guard.condition = branch_;
        }
      return value;
    } catch (const std::invalid_argument& error) {
      throw FormulaError(e.place.line, e.place.column, error.what());
    } catch (const std::domain_error& error) {
      throw FormulaError(e.place.line, e.place.column, error.what());
    } catch (const std::length_error& error) {
      throw FormulaError(e.place.line, e.place.column, error.what());
    }
  }

  Values v;

 private:
  void assign(const Statement& s) {
    if (fixed_.contains(s.target))
      throw FormulaError(s.place.line, s.place.column, "'" + s.target + "' cannot be set");
    if (is_function(s.target))
      throw FormulaError(s.place.line, s.place.column,
                         "'" + s.target + "' is a function; choose another name");
    Value value = value_of(s.value);
    const auto old = variables_.find(s.target);
    if (!s.members.empty()) {
      if (old == variables_.end())
        throw FormulaError(s.place.line, s.place.column, "'" + s.target + "' has no value yet");
      try {
        value = v.with_member(old->second, s.members, value);
      } catch (const std::invalid_argument& error) {
        throw FormulaError(s.place.line, s.place.column, error.what());
      }
    }
    if (old != variables_.end() && old->second.type != value.type)
      throw FormulaError(
          s.value.place.line, s.value.place.column,
          "'" + s.target + "' is a " + name_of(old->second.type) + ", found a " + name_of(value.type));
    variables_[s.target] = value;
    set_[s.target] = true;
  }

  Value lower(const Expression& e) {
    switch (e.kind) {
      case Expression::Kind::number:
        return v.number(e.value);
      case Expression::Kind::name:
        return named(e.text);
      case Expression::Kind::negate:
        return v.negate(value_of(e.operands[0]));
      case Expression::Kind::opposite:
        return logical(e);
      case Expression::Kind::member:
        return v.members(value_of(e.operands[0]), e.text);
      case Expression::Kind::choose:
        return choice(e);
      case Expression::Kind::binary:
        return binary(e);
      case Expression::Kind::call:
        break;
    }
    if (e.text == "pow" && e.operands.size() == 2) return power(e);
    std::vector<Value> arguments;
    for (const Expression& operand : e.operands) arguments.push_back(value_of(operand));
    return call_function(v, e.text, arguments);
  }

  Value named(const std::string& name) const {
    if (const auto found = variables_.find(name); found != variables_.end()) return found->second;
    if (const auto found = fixed_.find(name); found != fixed_.end()) return found->second;
    std::string known;
    for (const auto* names : {&variables_, &fixed_})
      for (const auto& [each, value] : *names) known += (known.empty() ? "" : ", ") + each;
    if (is_function(name))
      throw std::invalid_argument("'" + name + "' is a function: write " + name + "(...)");
    if (is_reserved_word(name)) throw std::invalid_argument("'" + name + "' is a reserved word");
    throw std::invalid_argument("unknown name '" + name + "'; there are " + known);
  }

  Value logical(const Expression& e) {
    Value a = value_of(e.operands[0]);
    if (a.type != ValueType::condition) throw std::invalid_argument("'" + e.text + "' needs conditions");
    if (e.operands.size() == 1) {
      a.part[0] = g.apply(Op::opposite, a.x());
      return a;
    }
    const Value b = value_of(e.operands[1]);
    if (b.type != ValueType::condition) throw std::invalid_argument("'" + e.text + "' needs conditions");
    a.part[0] = g.apply(e.text == "&&" ? Op::both : Op::either, a.x(), b.x());
    a.depends_z |= b.depends_z;
    a.varies |= b.varies;
    return a;
  }

  /// What a branch computes matters only where it is taken.
  Value choice(const Expression& e) {
    const Value condition = value_of(e.operands[0]);
    const NodeId outer = branch_;
    const auto taken = [&](NodeId when, const Expression& operand) {
      if (condition.type == ValueType::condition)
        branch_ = outer == no_node ? when : g.apply(Op::both, outer, when);
      const Value value = value_of(operand);
      branch_ = outer;
      return value;
    };
    const Value a = taken(condition.x(), e.operands[1]);
    const Value b = taken(g.apply(Op::opposite, condition.x()), e.operands[2]);
    return v.choose(condition, a, b);
  }

  Value binary(const Expression& e) {
    if (e.text == "&&" || e.text == "||") return logical(e);
    if (e.text == "^") return power(e);
    const Value a = value_of(e.operands[0]), b = value_of(e.operands[1]);
    if (e.text == "+") return v.add(a, b);
    if (e.text == "-") return v.add(a, b, true);
    if (e.text == "*") return v.multiply(a, b);
    if (e.text == "/") return v.divide(a, b);
    return v.compare(e.text, a, b);
  }

  Value power(const Expression& e) {
    const Value base = value_of(e.operands[0]), exponent = value_of(e.operands[1]);
    std::optional<double> n;
    if (exponent.type == ValueType::scalar) {
      const Node& node = g[exponent.x()];
      if (node.op == Op::constant) n = node.value;
      if (node.op == Op::input && node.value >= in::parameter)
        n = parameter_values_.at(static_cast<std::size_t>(node.value) -
                                 static_cast<std::size_t>(in::parameter));
    }
    if (n && *n == std::floor(*n) && std::abs(*n) <= 16)
      return v.power(base, v.number(*n), static_cast<int>(*n));
    return v.power(base, exponent, std::nullopt);
  }

  Graph& g;
  const std::vector<double>& parameter_values_;
  NodeId branch_ = no_node;  // where what is being lowered is used; no_node: everywhere
  std::map<std::string, Value> fixed_, variables_;
  std::map<std::string, bool> set_;
};

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

/// Tangents of `outputs` along x, y and z; constants where they are.
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

/// c as the map sees it: with the start's slope and tangents where they are constants.
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
    z.tight = false;  // no running derivative is wanted here
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
    } catch (const std::logic_error& error) {  // of the graph, while it is differentiated
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
