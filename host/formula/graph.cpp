// Simplifies nodes as they are added; a GraphProgram keeps only those that its outputs need.
#include "formula/graph.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sundog {
namespace {

bool commutes(Op op) {
  return op == Op::add || op == Op::multiply || op == Op::minimum || op == Op::maximum || op == Op::both ||
         op == Op::either;
}

}  // namespace

double evaluate(Op op, double a, double b, double c) {
  switch (op) {
    case Op::constant:
    case Op::input:
      return a;
#define SUNDOG_OP(name, value) \
  case Op::name:               \
    return value;
      SUNDOG_FORMULA_OPS(SUNDOG_OP)
#undef SUNDOG_OP
  }
  return 0;
}

NodeId Graph::insert(const Node& node) {
  const auto key = std::tuple(node.op, node.a, node.b, node.c, node.value);
  if (const auto found = known_.find(key); found != known_.end()) {
    const auto other = aliases_.find(found->second);
    return other == aliases_.end() ? found->second : other->second;
  }
  if (nodes_.size() >= max_nodes) throw std::length_error("the formula is too long");
  nodes_.push_back(node);
  const auto id = static_cast<NodeId>(nodes_.size() - 1);
  known_[key] = id;
  return id;
}

bool Graph::is_not_negative(NodeId id, int depth) const {
  const Node& node = nodes_[id];
  if (not_negative_.contains(id)) return true;
  if (depth == 0) return false;
  switch (node.op) {
    case Op::constant:
      return node.value >= 0;
    case Op::multiply:
      return node.a == node.b;
    case Op::absolute:
    case Op::square_root:
      return true;
    case Op::add:
      return is_not_negative(node.a, depth - 1) && is_not_negative(node.b, depth - 1);
    case Op::maximum:
      return is_not_negative(node.a, depth - 1) || is_not_negative(node.b, depth - 1);
    default:
      return false;
  }
}

NodeId Graph::constant(double value) {
  if (!std::isfinite(static_cast<float>(value)))
    throw std::domain_error("the value is not a finite number of at most 3.4e38");
  return insert({Op::constant, no_node, no_node, no_node, value == 0 ? 0.0 : value});
}

NodeId Graph::input(int index) { return insert({Op::input, no_node, no_node, no_node, double(index)}); }

NodeId Graph::div(NodeId a, NodeId b) {
  if (is_constant(b)) {
    if (static_cast<float>(nodes_[b].value) == 0) throw std::domain_error("division by zero");
    return apply(Op::divide, a, b);
  }
  const NodeId size = apply(Op::absolute, b), tiny = constant(1e-30);
  const NodeId kept = choose(less(b, constant(0)), constant(-1e-30), tiny);
  return apply(Op::divide, a, choose(less(size, tiny), kept, b));
}

NodeId Graph::apply(Op op, NodeId a, NodeId b, NodeId c) {
  if (commutes(op) && b < a) std::swap(a, b);
  const bool fold = is_constant(a) && (b == no_node || is_constant(b)) && (c == no_node || is_constant(c));
  if (fold) {
    const auto value = [&](NodeId id) { return id == no_node ? 0.0 : nodes_[id].value; };
    return constant(evaluate(op, value(a), value(b), value(c)));
  }
  if (const NodeId id = simplified(op, a, b, c); id != no_node) return id;
  return insert({op, a, b, c, 0});
}

NodeId Graph::simplified(Op op, NodeId a, NodeId b, NodeId c) {
  switch (op) {
    case Op::add:
      if (is_constant(a, 0)) return b;
      if (is_constant(b, 0)) return a;
      if (nodes_[b].op == Op::negate) return sub(a, nodes_[b].a);
      if (nodes_[a].op == Op::negate) return sub(b, nodes_[a].a);
      return no_node;
    case Op::subtract:
      if (is_constant(b, 0)) return a;
      if (is_constant(a, 0)) return neg(b);
      if (a == b) return constant(0);
      return nodes_[b].op == Op::negate ? add(a, nodes_[b].a) : no_node;
    case Op::multiply:
      if (is_constant(a, 0) || is_constant(b, 0)) return constant(0);
      if (is_constant(a, 1)) return b;
      if (is_constant(b, 1)) return a;
      if (is_constant(a, -1)) return neg(b);
      return is_constant(b, -1) ? neg(a) : no_node;
    case Op::divide:
      if (is_constant(a, 0)) return a;
      return is_constant(b, 1) ? a : no_node;
    case Op::negate:
      return nodes_[a].op == Op::negate ? nodes_[a].a : no_node;
    case Op::absolute:
      return nodes_[a].op == Op::absolute || nodes_[a].op == Op::square_root ? a : no_node;
    case Op::minimum:
    case Op::maximum:
      return a == b ? a : no_node;
    case Op::power:
      return is_constant(b, 1) ? a : no_node;
    case Op::both:
    case Op::either:
      for (const auto& [known, other] : {std::pair(a, b), std::pair(b, a)})
        if (is_constant(known)) return (nodes_[known].value != 0) == (op == Op::both) ? other : known;
      return a == b ? a : no_node;
    case Op::choose:
      if (is_constant(a)) return nodes_[a].value != 0 ? b : c;
      return b == c ? b : no_node;
    default:
      return no_node;
  }
}

GraphProgram::GraphProgram(const Graph& graph, const std::vector<NodeId>& outputs) {
  NodeId last = 0;
  for (const NodeId id : outputs) last = std::max(last, id);
  std::vector<bool> needed(last + 1, false);
  for (const NodeId id : outputs) needed[id] = true;
  for (NodeId id = last + 1; id-- > 0;)
    if (needed[id])
      for (const NodeId operand : {graph[id].a, graph[id].b, graph[id].c})
        if (operand != no_node) needed[operand] = true;
  std::vector<NodeId> place(last + 1, no_node);
  const auto placed = [&](NodeId id) { return id == no_node ? no_node : place[id]; };
  for (NodeId id = 0; id <= last; ++id) {
    if (!needed[id]) continue;
    place[id] = static_cast<NodeId>(nodes_.size());
    const Node& node = graph[id];
    nodes_.push_back({node.op, placed(node.a), placed(node.b), placed(node.c), node.value});
  }
  for (const NodeId id : outputs) outputs_.push_back(place[id]);
  values_.resize(nodes_.size());
  results_.resize(outputs_.size());
}

const std::vector<double>& GraphProgram::run(const std::function<double(int)>& input) {
  const auto at = [&](NodeId id) { return id == no_node ? 0.0 : values_[id]; };
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    values_[i] = node.op == Op::constant ? node.value
                 : node.op == Op::input  ? input(static_cast<int>(node.value))
                                         : evaluate(node.op, at(node.a), at(node.b), at(node.c));
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) results_[i] = values_[outputs_[i]];
  return results_;
}

std::vector<double> evaluate(const Graph& graph, std::span<const NodeId> outputs,
                             const std::function<double(int)>& input) {
  return GraphProgram(graph, {outputs.begin(), outputs.end()}).run(input);
}

}  // namespace sundog
