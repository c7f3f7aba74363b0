#include "compile/fields/sdf_emit.h"

#include <fmt/format.h>

#include <algorithm>

namespace sundog {
namespace {

bool is_condition(Op op) {
  return op == Op::less || op == Op::less_equal || op == Op::both || op == Op::either || op == Op::opposite;
}

}  // namespace

std::string literal(double value) {
  if (value != static_cast<float>(value)) return fmt::format("(REAL)(LITERAL({:#.17g}))", value);
  std::string text = fmt::format("{:.9g}", static_cast<float>(value));
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return "(REAL)(" + text + "f)";
}

GraphPrinter::GraphPrinter(const Graph& graph, std::vector<NodeId> outputs, std::string prefix,
                           std::function<std::string(int)> input)
    : graph_(graph),
      outputs_(std::move(outputs)),
      prefix_(std::move(prefix)),
      input_(std::move(input)),
      uses_(graph.size(), 0),
      is_fused_(graph.size(), false),
      is_printed_(graph.size(), false) {
  count_uses();
}

void GraphPrinter::count_uses() {
  for (const NodeId id : outputs_) uses_[id] += 2;  // an output keeps its own name
  for (NodeId id = static_cast<NodeId>(graph_.size()); id-- > 0;) {
    if (uses_[id] == 0) continue;
    for (const NodeId operand : {graph_[id].a, graph_[id].b, graph_[id].c})
      if (operand != no_node) ++uses_[operand];
  }
  for (NodeId id = 0; id < graph_.size(); ++id) {
    const Node& node = graph_[id];
    if (uses_[id] == 0 || (node.op != Op::add && node.op != Op::subtract)) continue;
    const auto product = [&](NodeId x) { return graph_[x].op == Op::multiply && uses_[x] == 1; };
    // The second operand of a sum, the first of a difference: the orders of lib/core/lanes.h.
    const bool first = node.op == Op::subtract;
    if (product(first ? node.a : node.b))
      is_fused_[first ? node.a : node.b] = true;
    else if (product(first ? node.b : node.a))
      is_fused_[first ? node.b : node.a] = true;
  }
}

std::string GraphPrinter::text(NodeId id) const {
  const Node& node = graph_[id];
  if (node.op == Op::constant) return literal(node.value);
  if (node.op == Op::input) return input_(static_cast<int>(node.value));
  return prefix_ + std::to_string(id);
}

std::string GraphPrinter::sum(const Node& node) const {
  const bool minus = node.op == Op::subtract;
  const bool fused_a = fused(node.a), fused_b = fused(node.b);
  if (fused_b && !(minus && fused_a)) {
    const Node& m = graph_[node.b];
    return fmt::format("fma({}{}, {}, {})", minus ? "-" : "", text(m.a), text(m.b), text(node.a));
  }
  if (fused_a) {
    const Node& m = graph_[node.a];
    return fmt::format("fma({}, {}, {}{})", text(m.a), text(m.b), minus ? "-" : "", text(node.b));
  }
  return fmt::format("{} {} {}", text(node.a), minus ? "-" : "+", text(node.b));
}

std::string GraphPrinter::value(NodeId id) const {
  const Node& node = graph_[id];
  const auto call = [&](const char* name) {
    return node.b == no_node ? fmt::format("{}({})", name, text(node.a))
                             : fmt::format("{}({}, {})", name, text(node.a), text(node.b));
  };
  const auto infix = [&](const char* sign) {
    return fmt::format("{} {} {}", text(node.a), sign, text(node.b));
  };
  switch (node.op) {
    case Op::constant:
    case Op::input:
      return text(id);
    case Op::add:
    case Op::subtract:
      return sum(node);
    case Op::multiply:
      return infix("*");
    case Op::divide:
      return infix("/");
    case Op::negate:
      return fmt::format("-{}", text(node.a));
    case Op::absolute:
      return call("fabs");
    case Op::minimum:
      return call("real_min");
    case Op::maximum:
      return call("real_max");
    case Op::round_down:
      return call("floor");
    case Op::square_root:
      return call("real_sqrt");
    case Op::inverse_root:
      return fmt::format("inverse_root_power({}, {})", text(node.a), graph_[node.b].value);
    case Op::rough_inverse_root:
      return call("rough_rsqrt");
    case Op::sine:
      return call("sin");
    case Op::cosine:
      return call("cos");
    case Op::arc_cosine:
      return call("acos");
    case Op::arc_tangent:
      return call("atan2");
    case Op::exponential:
      return call("exp");
    case Op::logarithm:
      return call("real_log");
    case Op::power:
      return call("pow");
    case Op::less:
      return "MASK_OF(" + infix("<") + ")";
    case Op::less_equal:
      return "MASK_OF(" + infix("<=") + ")";
    case Op::both:
      return infix("&");
    case Op::either:
      return infix("|");
    case Op::opposite:
      return fmt::format("~{}", text(node.a));
    case Op::choose:
      return fmt::format("select({}, {}, {})", text(node.c), text(node.b), text(node.a));
  }
  return "";
}

std::string GraphPrinter::statement(NodeId id) const {
  return fmt::format("    const {} {} = {};\n", is_condition(graph_[id].op) ? "MASK" : "REAL", text(id),
                     value(id));
}

std::string GraphPrinter::invariant_statements(const std::function<bool(int)>& changes) {
  std::vector<bool> varies(graph_.size(), false);
  std::string out;
  for (NodeId id = 0; id < graph_.size(); ++id) {
    const Node& node = graph_[id];
    if (node.op == Op::constant) continue;
    if (node.op == Op::input) {
      varies[id] = changes(static_cast<int>(node.value));
      continue;
    }
    for (const NodeId operand : {node.a, node.b, node.c})
      if (operand != no_node && varies[operand]) varies[id] = true;
    if (varies[id] || uses_[id] == 0 || fused(id)) continue;
    out += statement(id);
    is_printed_[id] = true;
  }
  return out;
}

std::string GraphPrinter::remaining_statements() {
  std::string out;
  for (NodeId id = 0; id < graph_.size(); ++id) {
    const Op op = graph_[id].op;
    if (uses_[id] == 0 || fused(id) || is_printed_[id] || op == Op::constant || op == Op::input) continue;
    out += statement(id);
  }
  return out;
}

}  // namespace sundog
