// Emits straight-line graphs as statements of a field's code.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "compile/fields/field_code.h"
#include "formula/graph.h"

namespace sundog {

/// Emits one graph. Products used once, in a sum, become fma().
class GraphWriter {
 public:
  /// `prefix` names the variables; input(index) supplies an input, called once each. known(node), if given,
  /// supplies numbers that depend on parameters alone. `code` and `graph` must outlive this.
  GraphWriter(FieldCode& code, const Graph& graph, std::vector<NodeId> outputs, std::string prefix,
              std::function<Operand(int)> input, std::function<Operand(NodeId)> known = {});

  /// Emits nodes that do not depend on inputs for which `changes` holds; write_rest() emits the others.
  void write_invariants(const std::function<bool(int)>& changes);
  void write_rest();
  /// An emitted node, a constant or an input.
  Operand value(NodeId id);

 private:
  bool fused(NodeId id) const { return is_fused_[id]; }
  void write(NodeId id);
  void write_sum(NodeId id);
  void define(NodeId id, FieldOp op, Operands operands, std::size_t number = 0);
  void find_known();
  void count_uses();

  FieldCode& code_;
  const Graph& graph_;
  std::vector<NodeId> outputs_;
  std::string prefix_;
  std::function<Operand(int)> input_;
  std::function<Operand(NodeId)> known_;
  std::vector<int> uses_;
  std::vector<bool> is_fused_, is_known_;
  std::map<NodeId, Operand> values_;  // emitted nodes, inputs and known numbers
};

}  // namespace sundog
