// Powers. Integer powers of triplex numbers and quaternions use products only: with the axis part's length
// rho, the number is u + i rho and its n-th power A + i rho B, where A and B are polynomials in u and rho^2
// built by squaring. Squaring uses A^2 + rho^2 B^2 = r^(2k), so A' = 2 A^2 - r^(2k).
#include <cmath>

#include "formula/value.h"

namespace sundog {

class Powers {
 public:
  explicit Powers(Values& values) : v_(values), g(values.g) {}

  /// x^n for n >= 1 by squaring.
  NodeId whole(NodeId x, int n) {
    if (n == 1) return x;
    const NodeId half = whole(x, n / 2), square = g.mul(half, half);
    return n % 2 ? g.mul(square, x) : square;
  }

  /// |v|^n, n >= 0, from |v|^2; approximate for odd n.
  NodeId length_power(NodeId square, int n) {
    if (n == 0) return g.constant(1);
    if (n % 2 == 0) return whole(square, n / 2);
    const NodeId inverse = g.apply(Op::rough_inverse_root, g.max(square, g.constant(1e-30)));
    return g.mul(whole(square, n / 2 + 1), inverse);
  }

  struct Pair {
    NodeId a, b;
  };
  /// (u + i rho)^n = a + i rho b, where square = u^2 + rho^2.
  Pair imaginary(NodeId u, NodeId square, NodeId rho_square, int n) {
    if (n == 1) return {u, g.constant(1)};
    const Pair half = imaginary(u, square, rho_square, n / 2);
    const NodeId twice = g.scaled(half.a, 2);
    const Pair even{g.sub(g.mul(twice, half.a), whole(square, n / 2)), g.mul(twice, half.b)};
    if (n % 2 == 0) return even;
    return {g.sub(g.mul(even.a, u), g.mul(rho_square, even.b)), g.add(even.a, g.mul(u, even.b))};
  }

  /// (c + i s)^n of a unit number.
  Pair turned(NodeId c, NodeId s, int n) {
    if (n == 1) return {c, s};
    const Pair half = turned(c, s, n / 2);
    const NodeId twice = g.scaled(half.a, 2);
    const Pair even{g.sub(g.mul(twice, half.a), g.constant(1)), g.mul(twice, half.b)};
    if (n % 2 == 0) return even;
    return {g.sub(g.mul(even.a, c), g.mul(even.b, s)), g.add(g.mul(even.a, s), g.mul(even.b, c))};
  }

  /// The triplex power of White and Nylander (2009): r^n (sin nt cos nf, sin nt sin nf, cos nt), t from the z
  /// axis.
  Value triplex_whole(const Value& v, int n) {
    const NodeId square = v_.square_length(v).x();
    const NodeId rho_square = g.add(g.mul(v.x(), v.x()), g.mul(v.y(), v.y()));  // as in square_length3
    const Pair polar = imaginary(v.z(), square, rho_square, n);
    Value r = grown(v, square, n, polar.b);
    if (n <= 8) {  // rho^(n-1) fits into a float, which shortens the dependency chain
      const Pair around = imaginary(v.x(), rho_square, g.mul(v.y(), v.y()), n);
      const NodeId kept = g.max(rho_square, g.constant(1e-10));
      const NodeId factor =
          n > 1 ? g.mul(polar.b, g.apply(Op::inverse_root, kept, g.constant(n - 1))) : polar.b;
      r.part = {g.mul(factor, around.a), g.mul(factor, g.mul(v.y(), around.b)), polar.a, no_node};
      return r;
    }
    const NodeId inverse_rho = g.apply(Op::inverse_root, g.max(rho_square, g.constant(1e-30)), g.constant(1));
    const Pair around = turned(g.mul(v.x(), inverse_rho), g.mul(v.y(), inverse_rho), n);
    const NodeId rho = g.mul(g.mul(rho_square, inverse_rho), polar.b);
    r.part = {g.mul(rho, around.a), g.mul(rho, around.b), polar.a, no_node};
    return r;
  }

  Value triplex(const Value& v, const Value& n) {
    const NodeId square = v_.square_length(v).x(), r = g.sqrt(g.max(square, g.constant(1e-30)));
    const NodeId cosine = g.max(g.min(g.apply(Op::divide, v.z(), r), g.constant(1)), g.constant(-1));
    const NodeId t = g.mul(n.x(), g.apply(Op::arc_cosine, cosine));
    const NodeId f = g.mul(n.x(), g.apply(Op::arc_tangent, v.y(), v.x()));
    const NodeId grown_r = g.apply(Op::power, r, n.x());
    const NodeId rho = g.mul(grown_r, g.apply(Op::sine, t));
    const NodeId axis_distance =
        g.sqrt(g.max(g.add(g.mul(v.x(), v.x()), g.mul(v.y(), v.y())), g.constant(1e-30)));
    Value result = grown(v, r, n, g.apply(Op::divide, g.apply(Op::absolute, rho), axis_distance));
    result.part = {g.mul(rho, g.apply(Op::cosine, f)), g.mul(rho, g.apply(Op::sine, f)),
                   g.mul(grown_r, g.apply(Op::cosine, t)), no_node};
    return result;
  }

  Value quaternion_whole(const Value& v, int n) {
    const NodeId square = v_.square_length(v).x();
    const Pair p = imaginary(v.x(), square, axis_square(v), n);
    Value r = grown(v, square, n);
    r.part = {p.a, g.mul(v.y(), p.b), g.mul(v.z(), p.b), g.mul(v.w(), p.b)};
    return r;
  }

  Value quaternion(const Value& v, const Value& n) {
    const NodeId r = g.sqrt(g.max(v_.square_length(v).x(), g.constant(1e-30)));
    const NodeId axis = g.sqrt(g.max(axis_square(v), g.constant(1e-30)));
    const NodeId angle = g.mul(n.x(), g.apply(Op::arc_tangent, axis, v.x()));
    const NodeId grown_r = g.apply(Op::power, r, n.x());
    const NodeId b = g.apply(Op::divide, g.mul(grown_r, g.apply(Op::sine, angle)), axis);
    Value result = grown(v, r, n);
    result.part = {g.mul(grown_r, g.apply(Op::cosine, angle)), g.mul(v.y(), b), g.mul(v.z(), b),
                   g.mul(v.w(), b)};
    return result;
  }

 private:
  NodeId axis_square(const Value& v) {
    return g.add(g.mul(v.y(), v.y()), g.add(g.mul(v.z(), v.z()), g.mul(v.w(), v.w())));
  }

  /// A value without components whose slope is n |v|^(n-1) times v's. Around the axis, a triplex power
  /// stretches by n |sin nt / sin t| |v|^(n-1) = n `around`, which is larger near the poles.
  Value grown(const Value& v, NodeId square, int n, NodeId around = no_node) {
    Value r = v_.isometry(v);
    if (!v.varies || !v.tight) return r;
    NodeId stretch = length_power(square, n - 1);
    if (around != no_node && !v_.radial) stretch = g.max(stretch, g.apply(Op::absolute, around));
    r.slope = g.mul(g.scaled(stretch, n), v.slope);
    return r;
  }
  Value grown(const Value& v, NodeId length, const Value& n, NodeId around = no_node) {
    Value r = v_.isometry(v);
    r.tight &= !n.varies;
    if (!v.varies || !r.tight) return r;
    NodeId stretch = g.apply(Op::power, length, g.sub(n.x(), g.constant(1)));
    if (around != no_node && !v_.radial) stretch = g.max(stretch, around);
    r.slope = g.mul(g.mul(g.apply(Op::absolute, n.x()), stretch), v.slope);
    return r;
  }

  Values& v_;
  Graph& g;
};

Value Values::power(const Value& base, const Value& exponent, std::optional<int> whole) {
  require(exponent.type == ValueType::scalar, "an exponent is a number, not a " + name_of(exponent.type));
  require(base.type != ValueType::condition, "a condition has no power");
  Powers powers(*this);
  const int n = whole.value_or(0);
  if (base.type == ValueType::vec3)
    return n >= 1 ? powers.triplex_whole(base, n) : powers.triplex(base, exponent);
  if (base.type == ValueType::quat)
    return n >= 1 ? powers.quaternion_whole(base, n) : powers.quaternion(base, exponent);
  Value r = result(ValueType::scalar, {&base, &exponent});
  if (whole && n == 0)
    r.part[0] = g.constant(1);
  else if (whole)
    r.part[0] = n > 0 ? powers.whole(base.x(), n) : g.div(g.constant(1), powers.whole(base.x(), -n));
  else {
    if (base.varies) guards.push_back({base.x(), no_node, 0, 1e300, "a power that is not whole"});
    r.part[0] = g.apply(Op::power, g.max(base.x(), g.constant(1e-30)), exponent.x());
  }
  return r;
}

}  // namespace sundog
