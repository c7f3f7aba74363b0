// Lengths, products, and the folds of kaleidoscopic formulas.
#include <cmath>

#include "formula/value.h"

namespace sundog {

Value Values::dot(const Value& a, const Value& b) {
  require(a.type == b.type && a.size() > 1, "dot takes two vec3 or two quat");
  Value r = result(ValueType::scalar, {&a, &b});
  const auto m = [&](std::size_t i) { return g.mul(a.part[i], b.part[i]); };
  NodeId sum =
      m(static_cast<std::size_t>(a.size()) - 1);  // in the order of square_length3 and square_length4
  for (std::size_t i = static_cast<std::size_t>(a.size()) - 1; i-- > 0;) sum = g.add(m(i), sum);
  r.part[0] = sum;
  return r;
}

Value Values::square_length(const Value& v) { return dot(v, v); }

Value Values::length(const Value& v) {
  Value r = result(ValueType::scalar, {&v});
  r.part[0] = g.sqrt(square_length(v).x());
  r.tight = v.tight;
  r.slope = v.slope;
  return r;
}

Value Values::conjugate(const Value& v) {
  require(v.type == ValueType::quat, "conj takes a quat");
  Value r = isometry(v);
  r.part = {v.x(), g.neg(v.y()), g.neg(v.z()), g.neg(v.w())};
  return r;
}

/// Operator norm of a bicomplex number (z1 + z2 j, z1 = x + iy, z2 = z + iw): the larger of |z1 - i z2| and
/// |z1 + i z2|.
NodeId Values::bicomplex_norm(const Value& a) {
  const auto square = [&](NodeId x, NodeId y) { return g.add(g.mul(x, x), g.mul(y, y)); };
  return g.sqrt(g.max(square(g.add(a.x(), a.w()), g.sub(a.y(), a.z())),
                      square(g.sub(a.x(), a.w()), g.add(a.y(), a.z()))));
}

Value Values::bicomplex_product(const Value& a, const Value& b) {
  require(a.type == ValueType::quat && b.type == ValueType::quat, "bicomplex takes two quat");
  Value r = result(ValueType::quat, {&a, &b});
  const auto m = [&](NodeId p, NodeId q) { return g.mul(p, q); };
  r.part[0] = g.add(g.sub(g.sub(m(a.x(), b.x()), m(a.y(), b.y())), m(a.z(), b.z())), m(a.w(), b.w()));
  r.part[1] = g.sub(g.sub(g.add(m(a.x(), b.y()), m(a.y(), b.x())), m(a.z(), b.w())), m(a.w(), b.z()));
  r.part[2] = g.sub(g.add(g.sub(m(a.x(), b.z()), m(a.y(), b.w())), m(a.z(), b.x())), m(a.w(), b.y()));
  r.part[3] = g.add(g.add(g.add(m(a.x(), b.w()), m(a.y(), b.z())), m(a.z(), b.y())), m(a.w(), b.x()));
  r.tight = a.tight && b.tight;
  if (!r.varies || !r.tight) return r;
  const NodeId left = a.varies ? g.mul(bicomplex_norm(b), a.slope) : g.constant(0);
  r.slope = g.add(left, b.varies ? g.mul(bicomplex_norm(a), b.slope) : g.constant(0));
  return r;
}

Value Values::cross(const Value& a, const Value& b) {
  require(a.type == ValueType::vec3 && b.type == ValueType::vec3, "cross takes two vec3");
  Value r = result(ValueType::vec3, {&a, &b});
  const auto minor = [&](std::size_t i, std::size_t j) {
    return g.sub(g.mul(a.part[i], b.part[j]), g.mul(a.part[j], b.part[i]));
  };
  r.part = {minor(1, 2), minor(2, 0), minor(0, 1), no_node};
  return r;
}

/// A fold across a diagonal plane through the origin needs only two comparisons.
std::optional<Value> Values::cheap_fold(const Value& v, const Value& n, const Value& d) {
  double normal[3];
  if (!g.is_constant(d.x(), 0)) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!g.is_constant(n.part[i])) return std::nullopt;
    normal[i] = g[n.part[i]].value;
  }
  for (std::size_t zero = 0; zero < 3; ++zero) {
    const std::size_t i = (zero + 1) % 3, j = (zero + 2) % 3;
    if (normal[zero] != 0 || normal[i] == 0 || std::abs(normal[i]) != std::abs(normal[j])) continue;
    // With a = sign_i v_i and b = -sign_j v_j, keep the half space a > b: a' = max(a, b), b' = min(a, b).
    const auto with_sign = [&](NodeId x, bool negative) { return negative ? g.neg(x) : x; };
    const NodeId a = with_sign(v.part[i], normal[i] < 0), b = with_sign(v.part[j], normal[j] > 0);
    Value r = isometry(v);
    r.part = v.part;
    r.part[i] = with_sign(g.max(a, b), normal[i] < 0);
    r.part[j] = with_sign(g.min(a, b), normal[j] > 0);
    return r;
  }
  return std::nullopt;
}

Value Values::fold(const Value& v, const Value& n, const Value& d) {
  folds = true;
  require(v.type == ValueType::vec3 && n.type == ValueType::vec3 && d.type == ValueType::scalar,
          "fold takes a vec3, a normal (vec3) and a distance");
  if (auto cheap = cheap_fold(v, n, d)) return *cheap;
  const Value unit = divide(n, length(n));
  const NodeId behind = g.min(g.sub(dot(v, unit).x(), d.x()), g.constant(0));
  const NodeId twice = g.scaled(behind, 2);
  Value r = result(ValueType::vec3, {&v, &n, &d});
  for (std::size_t i = 0; i < 3; ++i) r.part[i] = g.sub(v.part[i], g.mul(twice, unit.part[i]));
  if (!n.varies && !d.varies) {
    r.tight = v.tight;
    r.slope = v.slope;
  }
  return r;
}

Value Values::box_fold(const Value& v, const Value& limit) {
  folds = true;
  const Value inner = clamped(v, negate(limit), limit);
  Value r = result(v.type, {&v, &limit});
  for (std::size_t i = 0; i < static_cast<std::size_t>(v.size()); ++i)
    r.part[i] = g.sub(g.scaled(inner.part[i], 2), v.part[i]);
  if (!limit.varies) {
    r.tight = v.tight;
    r.slope = v.slope;
  }
  return r;
}

/// Mandelbox's ball fold (Lowe 2010): inversion in the ball of radius `fixed`, linear inside `least`;
/// conformal, so lengths grow by its factor.
Value Values::ball_fold(const Value& v, const Value& least, const Value& fixed) {
  folds = true;
  require(v.size() > 1 && least.type == ValueType::scalar && fixed.type == ValueType::scalar,
          "ballfold takes a point and two radii");
  const NodeId square = square_length(v).x();
  const NodeId inner = g.max(square, g.mul(least.x(), least.x()));
  const NodeId factor = g.max(g.div(g.mul(fixed.x(), fixed.x()), inner), g.constant(1));
  Value r = result(v.type, {&v, &least, &fixed});
  for (std::size_t i = 0; i < static_cast<std::size_t>(v.size()); ++i) r.part[i] = g.mul(v.part[i], factor);
  if (v.varies && v.tight && !least.varies && !fixed.varies) {
    r.tight = true;
    r.slope = g.mul(factor, v.slope);
  }
  return r;
}

Value Values::invert(const Value& v, const Value& square_radius) {
  folds = true;
  require(v.size() > 1 && square_radius.type == ValueType::scalar,
          "invert takes a point and a squared radius");
  const NodeId factor =
      g.apply(Op::divide, square_radius.x(), g.max(square_length(v).x(), g.constant(1e-12)));
  Value r = result(v.type, {&v, &square_radius});
  for (std::size_t i = 0; i < static_cast<std::size_t>(v.size()); ++i) r.part[i] = g.mul(v.part[i], factor);
  if (v.varies && v.tight && !square_radius.varies) {
    r.tight = true;
    r.slope = g.mul(g.apply(Op::absolute, factor), v.slope);
  }
  return r;
}

Value Values::wrap(const Value& v, const Value& period) {
  folds = true;
  const Value cells = each(Op::round_down, each(Op::add, each(Op::divide, v, period), number(0.5)));
  Value r = add(v, each(Op::multiply, period, cells), true);
  if (!period.varies && r.type == v.type) {
    r.tight = v.tight;
    r.slope = v.slope;
  }
  return r;
}

/// Rodrigues' rotation about `axis` (any length) by `angle` radians.
Value Values::rotate(const Value& v, const Value& axis, const Value& angle) {
  require(v.type == ValueType::vec3 && axis.type == ValueType::vec3 && angle.type == ValueType::scalar,
          "rotate takes a vec3, an axis (vec3) and an angle");
  const Value k = divide(axis, length(axis));
  const NodeId c = g.apply(Op::cosine, angle.x()), s = g.apply(Op::sine, angle.x());
  const NodeId rest = g.mul(dot(k, v).x(), g.sub(g.constant(1), c));
  const Value kv = cross(k, v);
  Value r = result(ValueType::vec3, {&v, &axis, &angle});
  for (std::size_t i = 0; i < 3; ++i)
    r.part[i] = g.add(g.mul(v.part[i], c), g.add(g.mul(kv.part[i], s), g.mul(k.part[i], rest)));
  if (!axis.varies && !angle.varies) {
    r.tight = v.tight;
    r.slope = v.slope;
  }
  return r;
}

}  // namespace sundog
