// Straight-line graphs as OpenCL C over REAL.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scene/formula/graph.h"

namespace sundog {

/// Prints the statements of one graph. Products that are used once, in a sum, become fma().
class GraphPrinter {
 public:
  /// `prefix` names its variables; input(index) gives the text of an input.
  GraphPrinter(const Graph& graph, std::vector<NodeId> outputs, std::string prefix,
               std::function<std::string(int)> input);

  /// Statements for what does not change with the inputs for which `changes` holds, and for the rest.
  std::string invariant_statements(const std::function<bool(int)>& changes);
  std::string remaining_statements();
  /// The text by which a node's value is known.
  std::string text(NodeId id) const;

 private:
  bool fused(NodeId id) const { return is_fused_[id]; }
  std::string value(NodeId id) const;
  std::string sum(const Node& node) const;
  void count_uses();
  const Graph& graph_;
  std::vector<NodeId> outputs_;
  std::string prefix_;
  std::function<std::string(int)> input_;
  std::vector<int> uses_;
  std::vector<bool> is_fused_, is_printed_;
  std::string statement(NodeId id) const;
};

/// A number as an OpenCL C literal, by LITERAL() where a float does not hold it.
std::string literal(double value);

}  // namespace sundog
