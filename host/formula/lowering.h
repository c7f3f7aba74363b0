// Lowers statements and expressions to values in a graph. Internal to lower().
#pragma once
#include <map>
#include <string>
#include <vector>

#include "formula/definition.h"
#include "formula/graph.h"
#include "formula/syntax.h"
#include "formula/value.h"

namespace sundog {

/// Walks syntax trees and emits values into one graph. Errors are FormulaErrors with the place.
class Lowering {
 public:
  /// Defines pi and the definition's parameters with `values`, which must outlive this.
  Lowering(Graph& graph, const FormulaDefinition& definition, const std::vector<double>& values);

  /// Defines a name that statements may read but not set.
  void define(const std::string& name, const Value& value) { fixed_[name] = value; }
  /// Defines a variable that statements may set to another value of the same type.
  void declare(const std::string& name, const Value& value) { variables_[name] = value; }
  const Value& variable(const std::string& name) const { return variables_.at(name); }
  bool was_set(const std::string& name) const { return set_.contains(name); }

  void run(const std::vector<Statement>& statements);
  Value value_of(const Expression& e);

  Values v;

 private:
  void assign(const Statement& s);
  Value lower(const Expression& e);
  Value named(const std::string& name) const;
  Value logical(const Expression& e);
  Value choice(const Expression& e);
  Value binary(const Expression& e);
  Value power(const Expression& e);

  Graph& g;
  const std::vector<double>& parameter_values_;
  NodeId branch_ = no_node;  // condition under which the current code runs; no_node: always
  std::map<std::string, Value> fixed_, variables_;
  std::map<std::string, bool> set_;
};

}  // namespace sundog
