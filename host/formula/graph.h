// A formula as straight-line scalar code: nodes in evaluation order. Common subexpressions are shared and
// constants folded, so differentiation leaves no dead code.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <vector>

namespace sundog {

using NodeId = std::uint32_t;
inline constexpr NodeId no_node = 0xFFFFFFFFu;

/// less, less_equal, both, either and opposite return conditions; choose(condition, a, b) is a if it holds,
/// else b. All others return numbers. power takes a base >= 0; inverse_root is 1 / sqrt(a)^b of an a > 0 and
/// a constant integer b; rough_inverse_root is 1 / sqrt(a) to 1e-4, for slopes.
///
/// X(operation, its value for a, b and c): the only list of operations.
#define SUNDOG_FORMULA_OPS(X)             \
  X(add, a + b)                           \
  X(subtract, a - b)                      \
  X(multiply, (a * b))                    \
  X(divide, a / b)                        \
  X(negate, -a)                           \
  X(absolute, std::abs(a))                \
  X(minimum, std::fmin(a, b))             \
  X(maximum, std::fmax(a, b))             \
  X(round_down, std::floor(a))            \
  X(square_root, std::sqrt(a))            \
  X(inverse_root, std::pow(a, -0.5 * b))  \
  X(rough_inverse_root, 1 / std::sqrt(a)) \
  X(sine, std::sin(a))                    \
  X(cosine, std::cos(a))                  \
  X(arc_cosine, std::acos(a))             \
  X(arc_tangent, std::atan2(a, b))        \
  X(exponential, std::exp(a))             \
  X(logarithm, std::log(a))               \
  X(power, std::pow(a, b))                \
  X(less, a < b)                          \
  X(less_equal, a <= b)                   \
  X(both, a != 0 && b != 0)               \
  X(either, a != 0 || b != 0)             \
  X(opposite, a == 0)                     \
  X(choose, a != 0 ? b : c)

enum class Op {
  constant,
  input,
#define SUNDOG_OP(name, value) name,
  SUNDOG_FORMULA_OPS(SUNDOG_OP)
#undef SUNDOG_OP
};

struct Node {
  Op op = Op::constant;
  NodeId a = no_node, b = no_node, c = no_node;
  double value = 0;  // the value of a constant or the index of an input
};

/// Throws std::domain_error if a constant expression is not finite, std::length_error beyond max_nodes.
class Graph {
 public:
  static constexpr std::size_t max_nodes = 20000;

  NodeId constant(double value);
  NodeId input(int index);
  NodeId apply(Op op, NodeId a, NodeId b = no_node, NodeId c = no_node);

  NodeId add(NodeId a, NodeId b) { return apply(Op::add, a, b); }
  NodeId sub(NodeId a, NodeId b) { return apply(Op::subtract, a, b); }
  NodeId mul(NodeId a, NodeId b) { return apply(Op::multiply, a, b); }
  NodeId neg(NodeId a) { return apply(Op::negate, a); }
  NodeId min(NodeId a, NodeId b) { return apply(Op::minimum, a, b); }
  NodeId max(NodeId a, NodeId b) { return apply(Op::maximum, a, b); }
  NodeId choose(NodeId condition, NodeId a, NodeId b) { return apply(Op::choose, condition, a, b); }
  NodeId less(NodeId a, NodeId b) { return apply(Op::less, a, b); }
  /// a / b with |b| kept away from zero: a device never divides by zero.
  NodeId div(NodeId a, NodeId b);
  /// Square root of max(a, 0).
  NodeId sqrt(NodeId a) { return apply(Op::square_root, is_not_negative(a) ? a : max(a, constant(0))); }
  NodeId scaled(NodeId a, double k) { return mul(a, constant(k)); }

  /// Makes later requests for `node` return `alias`, an equal value that is already known.
  void alias(NodeId node, NodeId alias_) { aliases_[node] = alias_; }

  void mark_not_negative(NodeId id) { not_negative_.insert(id); }

  bool is_constant(NodeId id) const { return nodes_[id].op == Op::constant; }
  bool is_constant(NodeId id, double value) const { return is_constant(id) && nodes_[id].value == value; }
  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return nodes_.size(); }

 private:
  NodeId insert(const Node& node);
  bool is_not_negative(NodeId id, int depth = 8) const;
  NodeId simplified(Op op, NodeId a, NodeId b, NodeId c);
  std::vector<Node> nodes_;
  std::map<std::tuple<Op, NodeId, NodeId, NodeId, double>, NodeId> known_;
  std::map<NodeId, NodeId> aliases_;
  std::set<NodeId> not_negative_;
};

/// Values of `outputs` in double precision; input(index) supplies the inputs. Conditions are 0 or 1.
std::vector<double> evaluate(const Graph& graph, std::span<const NodeId> outputs,
                             const std::function<double(int)>& input);

/// Applies one operation as devices do.
double evaluate(Op op, double a, double b, double c);

/// The part of a graph that some outputs need, for evaluation at many points.
class GraphProgram {
 public:
  GraphProgram() = default;
  GraphProgram(const Graph& graph, const std::vector<NodeId>& outputs);
  /// The outputs' values in order; valid until the next run.
  const std::vector<double>& run(const std::function<double(int)>& input);
  std::size_t size() const { return nodes_.size(); }

 private:
  std::vector<Node> nodes_;
  std::vector<NodeId> outputs_;
  std::vector<double> values_, results_;
};

/// Forward-mode differentiation: tangents of `outputs` along one direction. tangent(index) gives an input's
/// tangent (a node; no_node: zero). Adds nodes to the graph.
std::vector<NodeId> differentiate(Graph& graph, std::span<const NodeId> outputs,
                                  const std::function<NodeId(int)>& tangent);

}  // namespace sundog
