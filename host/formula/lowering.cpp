// Walks each expression depth first and leaves the operations to Values and call_function(); errors carry the
// innermost place, and domain checks the branch that they are in.
#include "formula/lowering.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "base/names.h"
#include "formula/error.h"
#include "formula/functions.h"
#include "formula/lower.h"

namespace sundog {

namespace in = formula_input;

Lowering::Lowering(Graph& graph, const FormulaDefinition& definition, const std::vector<double>& values)
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

void Lowering::run(const std::vector<Statement>& statements) {
  for (const Statement& s : statements) assign(s);
}

Value Lowering::value_of(const Expression& e) {
  try {
    const Value value = lower(e);
    for (DomainGuard& guard : v.guards)
      if (guard.line == 0) {
        guard.line = e.place.line;
        guard.column = e.place.column;
        guard.condition = branch_;
      }
    return value;
  } catch (const std::logic_error& error) {  // the function or operator rejects its operands
    throw FormulaError(e.place.line, e.place.column, error.what());
  }
}

void Lowering::assign(const Statement& s) {
  if (fixed_.contains(s.target))
    throw FormulaError(s.place.line, s.place.column, "'" + s.target + "' cannot be set");
  if (is_function(s.target))
    throw FormulaError(s.place.line, s.place.column, "'" + s.target + "' is a function; choose another name");
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

Value Lowering::lower(const Expression& e) {
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

Value Lowering::named(const std::string& name) const {
  if (const auto found = variables_.find(name); found != variables_.end()) return found->second;
  if (const auto found = fixed_.find(name); found != fixed_.end()) return found->second;
  if (is_function(name)) throw std::invalid_argument("'" + name + "' is a function: write " + name + "(...)");
  if (is_reserved_word(name)) throw std::invalid_argument("'" + name + "' is a reserved word");
  std::vector<std::string> names;
  std::string known;
  for (const auto* table : {&variables_, &fixed_})
    for (const auto& [each, value] : *table) {
      names.push_back(each);
      known += (known.empty() ? "there are " : ", ") + each;
    }
  throw std::invalid_argument("unknown name '" + name + "': " + did_you_mean(name, names, known, "'"));
}

Value Lowering::logical(const Expression& e) {
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

// Domain checks in a branch apply only if it is taken.
Value Lowering::choice(const Expression& e) {
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

Value Lowering::binary(const Expression& e) {
  if (e.text == "&&" || e.text == "||") return logical(e);
  if (e.text == "^") return power(e);
  const Value a = value_of(e.operands[0]), b = value_of(e.operands[1]);
  if (e.text == "+") return v.add(a, b);
  if (e.text == "-") return v.add(a, b, true);
  if (e.text == "*") return v.multiply(a, b);
  if (e.text == "/") return v.divide(a, b);
  return v.compare(e.text, a, b);
}

Value Lowering::power(const Expression& e) {
  const Value base = value_of(e.operands[0]), exponent = value_of(e.operands[1]);
  std::optional<double> n;
  if (exponent.type == ValueType::scalar) {
    const Node& node = g[exponent.x()];
    if (node.op == Op::constant) n = node.value;
    if (node.op == Op::input && node.value >= in::parameter)
      n = parameter_values_.at(static_cast<std::size_t>(node.value) -
                               static_cast<std::size_t>(in::parameter));
  }
  // A number's literal exponent takes few multiplications; each value of others needs its own kernel.
  const double most = base.type == ValueType::scalar && g.is_constant(exponent.x()) ? 1024 : 16;
  if (n && *n == std::floor(*n) && std::abs(*n) <= most)
    return v.power(base, v.number(*n), static_cast<int>(*n));
  return v.power(base, exponent, std::nullopt);
}

}  // namespace sundog
