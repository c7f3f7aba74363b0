// Forward-mode automatic differentiation of a formula's graph (Wengert 1964): computes each node's tangent
// from its operands' tangents.
#include <algorithm>

#include "formula/graph.h"

namespace sundog {
namespace {

/// Tangents of the nodes so far; no_node is zero.
class Tangents {
 public:
  Tangents(Graph& graph, const std::function<NodeId(int)>& of_input) : g_(graph), of_input_(of_input) {}

  void visit(NodeId id) { tangents_.push_back(rule(id, g_[id])); }
  NodeId of(NodeId id) const { return tangents_[id]; }

 private:
  // k a' + m b', with no_node as zero
  NodeId sum(NodeId x, NodeId y) { return x == no_node ? y : y == no_node ? x : zero_is_none(g_.add(x, y)); }
  NodeId times(NodeId k, NodeId x) { return x == no_node ? no_node : zero_is_none(g_.mul(k, x)); }
  NodeId minus(NodeId x) { return x == no_node ? no_node : g_.neg(x); }
  NodeId over(NodeId x, NodeId y) { return x == no_node ? no_node : g_.apply(Op::divide, x, y); }
  NodeId zero_is_none(NodeId x) { return g_.is_constant(x, 0) ? no_node : x; }
  NodeId pick(NodeId condition, NodeId x, NodeId y) {
    if (x == y) return x;
    const NodeId zero = g_.constant(0);
    return zero_is_none(g_.choose(condition, x == no_node ? zero : x, y == no_node ? zero : y));
  }
  NodeId kept_from_zero(NodeId x) { return g_.max(x, g_.constant(1e-30)); }

  NodeId rule(NodeId id, Node node) {  // by value: adding nodes moves the graph's
    if (node.op == Op::input) return of_input_(static_cast<int>(node.value));
    if (node.op == Op::constant) return no_node;
    const NodeId da = of(node.a), db = node.b == no_node ? no_node : of(node.b);
    const NodeId dc = node.c == no_node ? no_node : of(node.c);
    if (da == no_node && db == no_node && dc == no_node) return no_node;
    switch (node.op) {
      case Op::add:
        return sum(da, db);
      case Op::subtract:
        return sum(da, minus(db));
      case Op::multiply:
        return sum(times(node.b, da), times(node.a, db));
      case Op::divide:
        return over(sum(da, minus(times(id, db))), node.b);
      case Op::negate:
        return minus(da);
      case Op::minimum:
        return pick(g_.less(node.a, node.b), da, db);
      case Op::maximum:
        return pick(g_.less(node.b, node.a), da, db);
      case Op::choose:
        return pick(node.a, db, dc);
      default:
        return of_function(id, node, da, db);
    }
  }

  NodeId of_function(NodeId id, const Node& node, NodeId da, NodeId db) {
    switch (node.op) {
      case Op::absolute:
        return pick(g_.less(node.a, g_.constant(0)), minus(da), da);
      case Op::square_root:
        return over(times(g_.constant(0.5), da), kept_from_zero(id));
      case Op::inverse_root:
        return times(g_.scaled(g_.mul(id, g_.apply(Op::inverse_root, node.a, g_.constant(2))),
                               -0.5 * g_[node.b].value),
                     da);
      case Op::rough_inverse_root:
        return times(g_.scaled(g_.mul(g_.mul(id, id), id), -0.5), da);
      case Op::sine:
        return times(g_.apply(Op::cosine, node.a), da);
      case Op::cosine:
        return times(g_.neg(g_.apply(Op::sine, node.a)), da);
      case Op::arc_cosine:
        return minus(over(da, kept_from_zero(g_.sqrt(g_.sub(g_.constant(1), g_.mul(node.a, node.a))))));
      case Op::arc_tangent: {
        const NodeId square = g_.add(g_.mul(node.a, node.a), g_.mul(node.b, node.b));
        return over(sum(times(node.b, da), minus(times(node.a, db))), kept_from_zero(square));
      }
      case Op::exponential:
        return times(id, da);
      case Op::logarithm:
        return over(da, node.a);
      case Op::power:
        return of_power(node, da, db);
      default:
        return no_node;  // round_down and conditions are piecewise constant
    }
  }

  // (a^b)' = b a^(b-1) a' + a^b log(a) b'
  NodeId of_power(const Node& node, NodeId da, NodeId db) {
    const NodeId a = kept_from_zero(node.a);
    const NodeId lower = g_.apply(Op::power, a, g_.sub(node.b, g_.constant(1)));
    const NodeId by_base = times(g_.mul(node.b, lower), da);
    if (db == no_node) return by_base;
    return sum(by_base, times(g_.mul(g_.apply(Op::power, a, node.b), g_.apply(Op::logarithm, a)), db));
  }

  Graph& g_;
  const std::function<NodeId(int)>& of_input_;
  std::vector<NodeId> tangents_;
};

}  // namespace

std::vector<NodeId> differentiate(Graph& graph, std::span<const NodeId> outputs,
                                  const std::function<NodeId(int)>& tangent) {
  NodeId last = 0;
  for (const NodeId id : outputs) last = std::max(last, id);
  Tangents tangents(graph, tangent);
  for (NodeId id = 0; id <= last; ++id) tangents.visit(id);
  std::vector<NodeId> result;
  for (const NodeId id : outputs) result.push_back(tangents.of(id));
  return result;
}

}  // namespace sundog
