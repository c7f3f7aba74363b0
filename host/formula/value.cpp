// Each operation checks types, adds nodes to the graph, and determines whether the slope is a tight bound.
#include "formula/value.h"

#include <cmath>
#include <stdexcept>

namespace sundog {

std::string name_of(ValueType type) {
  switch (type) {
    case ValueType::condition:
      return "condition";
    case ValueType::scalar:
      return "number";
    case ValueType::vec3:
      return "vec3";
    case ValueType::quat:
      return "quat";
  }
  return "";
}

void Values::require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

/// A value computed from others. It varies if an operand does, and then has no tight slope until a rule sets
/// one.
Value Values::result(ValueType type, std::initializer_list<const Value*> from) {
  Value r;
  r.type = type;
  for (const Value* v : from) {
    r.varies |= v->varies;
    r.depends_z |= v->depends_z;
  }
  r.tight = !r.varies;
  return r;
}

Value Values::isometry(const Value& from) {
  Value r = from;
  r.part.fill(no_node);
  return r;
}

Value Values::number(double value) {
  Value r;
  r.part[0] = g.constant(value);
  return r;
}

Value Values::vector(const Value& x, const Value& y, const Value& z) {
  for (const Value* v : {&x, &y, &z}) require(v->type == ValueType::scalar, "vec3 takes three numbers");
  Value r = result(ValueType::vec3, {&x, &y, &z});
  r.part = {x.x(), y.x(), z.x(), no_node};
  return r;
}

Value Values::quaternion(const Value& x, const Value& y, const Value& z, const Value& w) {
  for (const Value* v : {&x, &y, &z, &w})
    require(v->type == ValueType::scalar, "quat takes four numbers, or a vec3 and a number");
  Value r = result(ValueType::quat, {&x, &y, &z, &w});
  r.part = {x.x(), y.x(), z.x(), w.x()};
  return r;
}

Value Values::members(const Value& v, const std::string& names) {
  require(v.size() > 1, "a " + name_of(v.type) + " has no components");
  require(names.size() == 1 || names.size() == 3, "components are one of xyzw or three, such as zxy");
  Value r = v;
  r.type = names.size() == 1 ? ValueType::scalar : ValueType::vec3;
  r.part.fill(no_node);
  std::string seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto at = std::string("xyzw").find(names[i]);
    require(at < static_cast<std::size_t>(v.size()),
            "a " + name_of(v.type) + " has no component '" + names[i] + "'");
    if (seen.find(names[i]) != std::string::npos) r.tight &= !r.varies;
    seen += names[i];
    r.part[i] = v.part[at];
  }
  return r;
}

Value Values::with_member(const Value& v, const std::string& name, const Value& part) {
  require(v.size() > 1, "a " + name_of(v.type) + " has no components");
  const auto at = std::string("xyzw").find(name);
  require(name.size() == 1 && at < static_cast<std::size_t>(v.size()),
          "a " + name_of(v.type) + " has no component '" + name + "' to set");
  require(part.type == ValueType::scalar, "a component is a number, not a " + name_of(part.type));
  Value r = result(v.type, {&v, &part});
  r.part = v.part;
  r.part[at] = part.x();
  return r;
}

Value Values::widened(const Value& scalar, ValueType type) {
  Value r = scalar;
  r.type = type;
  for (int i = 0; i < r.size(); ++i) r.part[static_cast<std::size_t>(i)] = scalar.x();
  r.tight &= !r.varies;
  return r;
}

Value Values::add(const Value& a, const Value& b, bool subtract) {
  const Op op = subtract ? Op::subtract : Op::add;
  Value left = a, right = b;
  if (a.type != b.type) {
    require(a.type == ValueType::scalar || b.type == ValueType::scalar,
            "a " + name_of(a.type) + " and a " + name_of(b.type) + " cannot be added");
    Value& scalar = a.type == ValueType::scalar ? left : right;
    const ValueType type = a.type == ValueType::scalar ? b.type : a.type;
    if (type == ValueType::quat)  // a number becomes a quaternion's real part
      scalar = quaternion(scalar, number(0), number(0), number(0));
    else
      scalar = widened(scalar, type);
  }
  require(left.type != ValueType::condition, "conditions cannot be added");
  Value r = result(left.type, {&left, &right});
  for (std::size_t i = 0; i < static_cast<std::size_t>(r.size()); ++i)
    r.part[i] = g.apply(op, left.part[i], right.part[i]);
  if (!r.varies) return r;
  r.tight = left.tight && right.tight && !(left.depends_z && right.depends_z);
  if (!left.varies)
    r.slope = right.slope;
  else if (!right.varies)
    r.slope = left.slope;
  else if (r.tight)
    r.slope = g.add(left.slope, right.slope);
  return r;
}

Value Values::negate(const Value& a) {
  require(a.type != ValueType::condition, "a condition has no sign; use !");
  Value r = isometry(a);
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.size()); ++i) r.part[i] = g.neg(a.part[i]);
  return r;
}

Value Values::multiply(const Value& a, const Value& b) {
  require(a.type != ValueType::condition && b.type != ValueType::condition,
          "conditions cannot be multiplied");
  if (a.type == ValueType::quat && b.type == ValueType::quat) return quaternion_product(a, b);
  if (a.type == ValueType::scalar) return scaled(b, a);
  if (b.type == ValueType::scalar) return scaled(a, b);
  require(a.type == b.type, "a " + name_of(a.type) + " and a " + name_of(b.type) + " cannot be multiplied");
  return product_of_parts(a, b);
}

Value Values::quaternion_product(const Value& a, const Value& b) {
  Value r = result(ValueType::quat, {&a, &b});
  const auto m = [&](NodeId p, NodeId q) { return g.mul(p, q); };
  // p + q + s - t
  const auto part = [&](NodeId p, NodeId q, NodeId s, NodeId t) { return g.sub(g.add(g.add(p, q), s), t); };
  r.part[0] = g.sub(g.sub(g.sub(m(a.x(), b.x()), m(a.y(), b.y())), m(a.z(), b.z())), m(a.w(), b.w()));
  r.part[1] = part(m(a.x(), b.y()), m(a.y(), b.x()), m(a.z(), b.w()), m(a.w(), b.z()));
  r.part[2] = part(m(a.x(), b.z()), m(a.z(), b.x()), m(a.w(), b.y()), m(a.y(), b.w()));
  r.part[3] = part(m(a.x(), b.w()), m(a.w(), b.x()), m(a.y(), b.z()), m(a.z(), b.y()));
  r.tight = a.tight && b.tight;
  if (!r.varies || !r.tight) return r;
  const NodeId left = a.varies ? g.mul(length(b).x(), a.slope) : g.constant(0);
  const NodeId right = b.varies ? g.mul(length(a).x(), b.slope) : g.constant(0);
  r.slope = g.add(left, right);
  return r;
}

Value Values::product_of_parts(const Value& a, const Value& b) {
  Value r = each(Op::multiply, a, b);
  const Value& v = a.varies ? a : b;
  const Value& k = a.varies ? b : a;
  if (v.varies && !k.varies && v.tight && g.is_constant(k.x()) && g.is_constant(k.y()) &&
      g.is_constant(k.z())) {
    const double s = std::abs(g[k.x()].value);
    r.tight = s == std::abs(g[k.y()].value) && s == std::abs(g[k.z()].value);
    r.slope = g.scaled(v.slope, s);
  }
  return r;
}

Value Values::scaled(const Value& v, const Value& k) {
  Value r = result(v.type, {&v, &k});
  for (std::size_t i = 0; i < static_cast<std::size_t>(r.size()); ++i) r.part[i] = g.mul(v.part[i], k.x());
  if (v.varies && !k.varies && v.tight) {
    r.tight = true;
    r.slope = g.mul(g.apply(Op::absolute, k.x()), v.slope);
  }
  return r;
}

Value Values::divide(const Value& a, const Value& b) {
  require(a.type != ValueType::condition && b.type != ValueType::condition, "conditions cannot be divided");
  if (b.type == ValueType::quat) {
    const Value square = square_length(b);
    return multiply(a, divide(conjugate(b), square));
  }
  if (b.type == ValueType::scalar && a.type != ValueType::scalar) {
    Value r = result(a.type, {&a, &b});
    for (std::size_t i = 0; i < static_cast<std::size_t>(r.size()); ++i) r.part[i] = g.div(a.part[i], b.x());
    if (a.varies && !b.varies && a.tight) {
      r.tight = true;
      r.slope = g.div(a.slope, g.apply(Op::absolute, b.x()));
    }
    return r;
  }
  return each(Op::divide, a, b);
}

Value Values::compare(const std::string& sign, const Value& a, const Value& b) {
  require(a.type == ValueType::scalar && b.type == ValueType::scalar, "only numbers can be compared");
  Value r = result(ValueType::condition, {&a, &b});
  const NodeId x = a.x(), y = b.x();
  if (sign == "<") r.part[0] = g.less(x, y);
  if (sign == ">") r.part[0] = g.less(y, x);
  if (sign == "<=") r.part[0] = g.apply(Op::less_equal, x, y);
  if (sign == ">=") r.part[0] = g.apply(Op::less_equal, y, x);
  if (sign == "==" || sign == "!=") {
    r.part[0] = g.apply(Op::both, g.apply(Op::less_equal, x, y), g.apply(Op::less_equal, y, x));
    if (sign == "!=") r.part[0] = g.apply(Op::opposite, r.part[0]);
  }
  return r;
}

Value Values::choose(const Value& condition, const Value& a, const Value& b) {
  require(condition.type == ValueType::condition, "a choice needs a condition, such as x < 0, before '?'");
  require(a.type == b.type,
          "both sides of a choice must be of one type, found " + name_of(a.type) + " and " + name_of(b.type));
  Value r = result(a.type, {&a, &b});
  r.depends_z |= condition.depends_z;
  if (r.type == ValueType::condition) {
    const NodeId of_b = g.apply(Op::both, g.apply(Op::opposite, condition.x()), b.x());
    r.part[0] = g.apply(Op::either, g.apply(Op::both, condition.x(), a.x()), of_b);
    return r;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(r.size()); ++i)
    r.part[i] = g.choose(condition.x(), a.part[i], b.part[i]);
  r.tight = a.tight && b.tight;
  if (r.tight && r.varies) {
    const NodeId zero = g.constant(0);
    r.slope = g.choose(condition.x(), a.varies ? a.slope : zero, b.varies ? b.slope : zero);
  }
  return r;
}

Value Values::each(Op op, const Value& a) {
  folds |= op == Op::absolute && a.size() > 1;
  require(a.type != ValueType::condition, "a condition is no number");
  Value r = result(a.type, {&a});
  for (std::size_t i = 0; i < static_cast<std::size_t>(r.size()); ++i) r.part[i] = g.apply(op, a.part[i]);
  if (op == Op::absolute) {  // reflections
    r.tight = a.tight;
    r.slope = a.slope;
  }
  return r;
}

Value Values::each(Op op, const Value& a, const Value& b) {
  require(a.type != ValueType::condition && b.type != ValueType::condition, "a condition is no number");
  const ValueType type = a.size() > b.size() ? a.type : b.type;
  require(a.type == b.type || a.type == ValueType::scalar || b.type == ValueType::scalar,
          "a " + name_of(a.type) + " and a " + name_of(b.type) + " do not go together");
  const Value left = a.type == type ? a : widened(a, type), right = b.type == type ? b : widened(b, type);
  Value r = result(type, {&a, &b});
  for (std::size_t i = 0; i < static_cast<std::size_t>(r.size()); ++i)
    r.part[i] =
        op == Op::divide ? g.div(left.part[i], right.part[i]) : g.apply(op, left.part[i], right.part[i]);
  if ((op == Op::minimum || op == Op::maximum) && a.varies != b.varies) {
    r.tight = (a.varies ? left : right).tight;
    r.slope = (a.varies ? left : right).slope;
  }
  return r;
}

Value Values::clamped(const Value& v, const Value& low, const Value& high) {
  return each(Op::minimum, each(Op::maximum, v, low), high);
}

}  // namespace sundog
