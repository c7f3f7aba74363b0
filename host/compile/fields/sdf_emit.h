// Straight-line graphs as statements of a field's code.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "compile/fields/field_code.h"
#include "scene/formula/graph.h"

namespace sundog {

/// Writes the statements of one graph. Products that are used once, in a sum, become fma().
class GraphWriter {
 public:
  /// `prefix` names its variables; input(index) gives an input, asked once each. `code` and `graph` must
  /// outlive it.
  GraphWriter(FieldCode& code, const Graph& graph, std::vector<NodeId> outputs, std::string prefix,
              std::function<Operand(int)> input);

  /// Statements for what does not change with the inputs for which `changes` holds, and for the rest.
  void write_invariants(const std::function<bool(int)>& changes);
  void write_rest();
  /// A node that is written, a constant or an input.
  Operand value(NodeId id);

 private:
  bool fused(NodeId id) const { return is_fused_[id]; }
  void write(NodeId id);
  void write_sum(NodeId id);
  void define(NodeId id, FieldOp op, Operands operands, std::size_t number = 0);
  void count_uses();

  FieldCode& code_;
  const Graph& graph_;
  std::vector<NodeId> outputs_;
  std::string prefix_;
  std::function<Operand(int)> input_;
  std::vector<int> uses_;
  std::vector<bool> is_fused_;
  std::map<NodeId, Operand> values_;  // of what is written, and of inputs
};

}  // namespace sundog
