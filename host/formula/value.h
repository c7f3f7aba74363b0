// Typed values of the formula language over a scalar graph, with the rules of the running derivative
// (lower.h).
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "formula/graph.h"

namespace sundog {

enum class ValueType { condition, scalar, vec3, quat };

std::string name_of(ValueType type);

/// A value and a bound `slope` on its rate of change with p. The bound is valid only if `tight`; otherwise it
/// would be too loose, and exact differentiation replaces it.
struct Value {
  ValueType type = ValueType::scalar;
  std::array<NodeId, 4> part{no_node, no_node, no_node, no_node};
  bool varies = false;     // changes with p
  bool depends_z = false;  // varies through z
  bool tight = true;
  NodeId slope = no_node;

  int size() const { return type == ValueType::quat ? 4 : type == ValueType::vec3 ? 3 : 1; }
  NodeId x() const { return part[0]; }
  NodeId y() const { return part[1]; }
  NodeId z() const { return part[2]; }
  NodeId w() const { return part[3]; }
};

/// A function's argument that must lie in its domain [low, high]. `condition`, if any, tells whether the
/// argument is used.
struct DomainGuard {
  NodeId argument = no_node, condition = no_node;
  double low = 0, high = 0;
  std::string function;
  int line = 0, column = 0;
};

/// Operations on values. Throw std::invalid_argument with the reason if operand types do not fit.
class Values {
 public:
  explicit Values(Graph& graph) : g(graph) {}

  Value number(double value);
  Value vector(const Value& x, const Value& y, const Value& z);
  Value quaternion(const Value& x, const Value& y, const Value& z, const Value& w);
  Value members(const Value& v, const std::string& names);
  Value with_member(const Value& v, const std::string& name, const Value& part);

  Value add(const Value& a, const Value& b, bool subtract = false);
  Value multiply(const Value& a, const Value& b);
  Value divide(const Value& a, const Value& b);
  Value negate(const Value& a);
  /// `whole`: the exponent if it is a known integer.
  Value power(const Value& base, const Value& exponent, std::optional<int> whole);
  Value compare(const std::string& sign, const Value& a, const Value& b);
  Value choose(const Value& condition, const Value& a, const Value& b);

  Value dot(const Value& a, const Value& b);
  Value square_length(const Value& v);
  Value length(const Value& v);
  Value conjugate(const Value& v);
  Value bicomplex_product(const Value& a, const Value& b);
  Value cross(const Value& a, const Value& b);
  /// Reflects to the side of the plane n.v = d that n points to.
  Value fold(const Value& v, const Value& n, const Value& d);
  Value box_fold(const Value& v, const Value& limit);
  Value ball_fold(const Value& v, const Value& least, const Value& fixed);
  Value invert(const Value& v, const Value& square_radius);
  Value wrap(const Value& v, const Value& period);
  Value rotate(const Value& v, const Value& axis, const Value& angle);
  /// Applies op per component, widening scalars to the other operand's type.
  Value each(Op op, const Value& a);
  Value each(Op op, const Value& a, const Value& b);
  Value clamped(const Value& v, const Value& low, const Value& high);

  Graph& g;
  std::vector<DomainGuard> guards;
  bool radial = false;  // triplex powers use the slope along z only
  bool folds = false;   // a fold, inversion or repetition was used; |z| counts as a fold

 private:
  friend class Powers;
  Value widened(const Value& scalar, ValueType type);
  Value result(ValueType type, std::initializer_list<const Value*> from);
  Value quaternion_product(const Value& a, const Value& b);
  Value product_of_parts(const Value& a, const Value& b);
  Value scaled(const Value& v, const Value& k);
  Value isometry(const Value& from);
  void require(bool holds, const std::string& what);
  std::optional<Value> cheap_fold(const Value& v, const Value& n, const Value& d);
  NodeId bicomplex_norm(const Value& a);
};

}  // namespace sundog
