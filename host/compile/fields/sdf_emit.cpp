// Emits graphs as statements; fuses a product that only one sum uses, and writes loop invariants before the
// loop.
#include "compile/fields/sdf_emit.h"

#include <algorithm>
#include <utility>

#include "formula/lower.h"

namespace sundog {
namespace {

/// The FieldOp of `op`; not for sums, choices and inverse roots, whose operands have another order.
FieldOp field_op(Op op) {
  static constexpr std::pair<Op, FieldOp> ops[] = {{Op::multiply, FIELD_MULTIPLY},
                                                   {Op::divide, FIELD_DIVIDE},
                                                   {Op::negate, FIELD_NEGATE},
                                                   {Op::absolute, FIELD_ABSOLUTE},
                                                   {Op::minimum, FIELD_MINIMUM},
                                                   {Op::maximum, FIELD_MAXIMUM},
                                                   {Op::round_down, FIELD_ROUND_DOWN},
                                                   {Op::square_root, FIELD_SQUARE_ROOT},
                                                   {Op::rough_inverse_root, FIELD_ROUGH_INVERSE_ROOT},
                                                   {Op::sine, FIELD_SINE},
                                                   {Op::cosine, FIELD_COSINE},
                                                   {Op::arc_cosine, FIELD_ARC_COSINE},
                                                   {Op::arc_tangent, FIELD_ARC_TANGENT},
                                                   {Op::exponential, FIELD_EXPONENTIAL},
                                                   {Op::logarithm, FIELD_LOGARITHM},
                                                   {Op::power, FIELD_POWER},
                                                   {Op::less, FIELD_LESS},
                                                   {Op::less_equal, FIELD_LESS_EQUAL},
                                                   {Op::both, FIELD_BOTH},
                                                   {Op::either, FIELD_EITHER},
                                                   {Op::opposite, FIELD_OPPOSITE}};
  const auto* found = std::ranges::find(ops, op, &std::pair<Op, FieldOp>::first);
  return found == std::end(ops) ? FIELD_COPY : found->second;
}

}  // namespace

GraphWriter::GraphWriter(FieldCode& code, const Graph& graph, std::vector<NodeId> outputs, std::string prefix,
                         std::function<Operand(int)> input, std::function<Operand(NodeId)> known)
    : code_(code),
      graph_(graph),
      outputs_(std::move(outputs)),
      prefix_(std::move(prefix)),
      input_(std::move(input)),
      known_(std::move(known)),
      uses_(graph.size(), 0),
      is_fused_(graph.size(), false),
      is_known_(graph.size(), false) {
  if (known_) find_known();
  count_uses();
}

/// Finds numbers that depend on parameters alone. Conditions have no place in a table.
void GraphWriter::find_known() {
  std::vector<bool> fixed(graph_.size(), false);
  for (NodeId id = 0; id < graph_.size(); ++id) {
    const Node& node = graph_[id];
    fixed[id] = node.op != Op::input || node.value >= formula_input::parameter;
    for (const NodeId operand : {node.a, node.b, node.c})
      if (operand != no_node && !fixed[operand]) fixed[id] = false;
    const bool computed = node.op != Op::constant && node.op != Op::input;
    is_known_[id] = fixed[id] && computed && !(node.op >= Op::less && node.op <= Op::opposite);
  }
}

void GraphWriter::count_uses() {
  for (const NodeId id : outputs_) uses_[id] += 2;  // an output keeps its own name
  for (NodeId id = static_cast<NodeId>(graph_.size()); id-- > 0;) {
    if (is_known_[id]) uses_[id] = 0;  // it is not emitted
    if (uses_[id] == 0) continue;
    for (const NodeId operand : {graph_[id].a, graph_[id].b, graph_[id].c})
      if (operand != no_node) ++uses_[operand];
  }
  for (NodeId id = 0; id < graph_.size(); ++id) {
    const Node& node = graph_[id];
    if (uses_[id] == 0 || (node.op != Op::add && node.op != Op::subtract)) continue;
    const auto product = [&](NodeId x) { return graph_[x].op == Op::multiply && uses_[x] == 1; };
    // Prefer the second operand of a sum and the first of a difference: the order of lib/core/lanes.h.
    const bool first = node.op == Op::subtract;
    if (product(first ? node.a : node.b))
      is_fused_[first ? node.a : node.b] = true;
    else if (product(first ? node.b : node.a))
      is_fused_[first ? node.b : node.a] = true;
  }
}

Operand GraphWriter::value(NodeId id) {
  const Node& node = graph_[id];
  if (node.op == Op::constant) return Operand::literal(node.value);
  if (const auto found = values_.find(id); found != values_.end()) return found->second;
  if (is_known_[id]) return values_[id] = known_(id);
  return values_[id] = input_(static_cast<int>(node.value));
}

void GraphWriter::define(NodeId id, FieldOp op, Operands operands, std::size_t number) {
  values_[id] = code_.define(prefix_ + std::to_string(id), op, std::move(operands), number);
}

void GraphWriter::write_sum(NodeId id) {
  const Node& node = graph_[id];
  const bool minus = node.op == Op::subtract;
  const bool fused_a = fused(node.a), fused_b = fused(node.b);
  if (fused_b && !(minus && fused_a)) {
    const Node& m = graph_[node.b];
    define(id, minus ? FIELD_FMA_LESS_A : FIELD_FMA, {value(m.a), value(m.b), value(node.a)});
  } else if (fused_a) {
    const Node& m = graph_[node.a];
    define(id, minus ? FIELD_FMA_LESS_C : FIELD_FMA, {value(m.a), value(m.b), value(node.b)});
  } else {
    define(id, minus ? FIELD_SUBTRACT : FIELD_ADD, {value(node.a), value(node.b)});
  }
}

void GraphWriter::write(NodeId id) {
  const Node& node = graph_[id];
  switch (node.op) {
    case Op::add:
    case Op::subtract:
      return write_sum(id);
    case Op::inverse_root:
      return define(id, FIELD_INVERSE_ROOT, {value(node.a)}, static_cast<std::size_t>(graph_[node.b].value));
    case Op::choose:
      return define(id, FIELD_CHOOSE, {value(node.c), value(node.b), value(node.a)});
    default:
      break;
  }
  Operands operands{value(node.a)};
  if (node.b != no_node) operands.push_back(value(node.b));
  define(id, field_op(node.op), std::move(operands));
}

void GraphWriter::write_invariants(const std::function<bool(int)>& changes) {
  std::vector<bool> varies(graph_.size(), false);
  for (NodeId id = 0; id < graph_.size(); ++id) {
    const Node& node = graph_[id];
    if (node.op == Op::constant) continue;
    if (node.op == Op::input) {
      varies[id] = changes(static_cast<int>(node.value));
      continue;
    }
    for (const NodeId operand : {node.a, node.b, node.c})
      if (operand != no_node && varies[operand]) varies[id] = true;
    if (!varies[id] && uses_[id] > 0 && !fused(id)) write(id);
  }
}

void GraphWriter::write_rest() {
  for (NodeId id = 0; id < graph_.size(); ++id) {
    const Op op = graph_[id].op;
    if (uses_[id] == 0 || fused(id) || values_.contains(id) || op == Op::constant || op == Op::input)
      continue;
    write(id);
  }
}

}  // namespace sundog
