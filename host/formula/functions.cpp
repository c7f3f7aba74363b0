// A function is a row: its call and meaning for the help, its range of argument counts, and its rule.
#include "formula/functions.h"

#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "base/names.h"

namespace sundog {
namespace {

using Arguments = std::vector<Value>;

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

const Value& scalar(const Value& v) {
  require(v.type == ValueType::scalar, "expected a number, found a " + name_of(v.type) +
                                           (v.size() > 1 ? ": take its components, as v.x" : ""));
  return v;
}

/// A function of one number in [low, high]: a constant outside is an error; other arguments are clamped and
/// guarded.
Value of_number(Values& v, Op op, const char* name, const Value& a, std::optional<double> low,
                std::optional<double> high) {
  Graph& g = v.g;
  NodeId x = scalar(a).x();
  if (g.is_constant(x))
    require((!low || g[x].value >= *low) && (!high || g[x].value <= *high),
            "the function is not defined at " + std::to_string(g[x].value));
  if ((low || high) && a.varies)
    v.guards.push_back({x, no_node, low.value_or(-1e300), high.value_or(1e300), name});
  if (low) x = g.max(x, g.constant(*low));
  if (high) x = g.min(x, g.constant(*high));
  Value inner = a;
  inner.part[0] = x;
  return v.each(op, inner);
}

Value sine(Values& v, const Value& a) { return of_number(v, Op::sine, "sin", a, {}, {}); }
Value cosine(Values& v, const Value& a) { return of_number(v, Op::cosine, "cos", a, {}, {}); }
Value exponential(Values& v, const Value& a) {  // e^80 leaves headroom in a float
  return v.each(Op::exponential, v.each(Op::minimum, scalar(a), v.number(80)));
}
Value hyperbolic(Values& v, const Value& a, bool subtract) {
  return v.multiply(v.number(0.5), v.add(exponential(v, a), exponential(v, v.negate(a)), subtract));
}
Value sign_of(Values& v, const Value& a) {
  const Value zero = v.number(0);
  return v.choose(v.compare("<", scalar(a), zero), v.number(-1),
                  v.choose(v.compare("<", zero, a), v.number(1), zero));
}
Value mix(Values& v, const Value& a, const Value& b, const Value& t) {
  return v.add(a, v.multiply(v.add(b, a, true), t));
}
/// Quadratic smooth minimum: min(a, b) if they differ by k or more.
Value smooth_minimum(Values& v, const Value& a, const Value& b, const Value& k) {
  const Value wide = v.each(Op::maximum, scalar(k), v.number(1e-6));
  const Value gap = v.each(Op::absolute, v.add(scalar(a), scalar(b), true));
  const Value h = v.each(Op::maximum, v.add(v.number(1), v.divide(gap, wide), true), v.number(0));
  const Value bulge = v.multiply(v.multiply(h, h), v.multiply(wide, v.number(0.25)));
  return v.add(v.each(Op::minimum, a, b), bulge, true);
}

struct Function {
  std::string call, meaning;
  std::size_t least, most;
  std::function<Value(Values&, const Arguments&)> apply;
};

Value make_quat(Values& v, const Arguments& a) {
  if (a.size() == 4) return v.quaternion(a[0], a[1], a[2], a[3]);
  require(a.size() == 2 && a[0].type == ValueType::vec3, "quat takes four numbers, or a vec3 and a number");
  Value r = v.quaternion(v.members(a[0], "x"), v.members(a[0], "y"), v.members(a[0], "z"), a[1]);
  if (a[0].varies && !a[1].varies) {  // embeds space isometrically
    r.tight = a[0].tight;
    r.slope = a[0].slope;
  }
  return r;
}

Value make_vec3(Values& v, const Arguments& a) {
  if (a.size() == 1) return v.vector(a[0], a[0], a[0]);
  require(a.size() == 3, "vec3 takes three numbers, or one");
  return v.vector(a[0], a[1], a[2]);
}

Value length_of(Values& v, const Arguments& a) {
  if (a.size() == 1) return v.length(a[0]);
  return v.each(Op::square_root, v.add(v.multiply(scalar(a[0]), a[0]), v.multiply(scalar(a[1]), a[1])));
}

std::map<std::string, Function> make_functions() {
  using A = const Arguments&;
  using V = Values&;
  const double turn = std::numbers::pi / 180;
  std::map<std::string, Function> f;
  f["abs"] = {"abs(x)", "absolute value; of a point by components", 1, 1,
              [](V v, A a) { return v.each(Op::absolute, a[0]); }};
  f["sign"] = {"sign(x)", "-1, 0 or 1", 1, 1, [](V v, A a) { return sign_of(v, a[0]); }};
  f["floor"] = {"floor(x)", "greatest whole number that is not above x", 1, 1,
                [](V v, A a) { return v.each(Op::round_down, a[0]); }};
  f["fract"] = {"fract(x)", "x - floor(x)", 1, 1,
                [](V v, A a) { return v.add(a[0], v.each(Op::round_down, a[0]), true); }};
  f["mod"] = {"mod(x, m)", "x - m floor(x / m)", 2, 2, [](V v, A a) {
                return v.add(a[0], v.multiply(v.each(Op::round_down, v.divide(a[0], a[1])), a[1]), true);
              }};
  f["min"] = {"min(a, b)", "lesser, by components", 2, 2,
              [](V v, A a) { return v.each(Op::minimum, a[0], a[1]); }};
  f["max"] = {"max(a, b)", "greater, by components", 2, 2,
              [](V v, A a) { return v.each(Op::maximum, a[0], a[1]); }};
  f["clamp"] = {"clamp(x, a, b)", "x kept within [a, b]", 3, 3,
                [](V v, A a) { return v.clamped(a[0], a[1], a[2]); }};
  f["mix"] = {"mix(a, b, t)", "a + (b - a) t", 3, 3, [](V v, A a) { return mix(v, a[0], a[1], a[2]); }};
  f["smooth_min"] = {"smooth_min(a, b, k)", "minimum, rounded where a and b differ by less than k", 3, 3,
                     [](V v, A a) { return smooth_minimum(v, a[0], a[1], a[2]); }};
  f["smooth_max"] = {"smooth_max(a, b, k)", "maximum, rounded likewise", 3, 3, [](V v, A a) {
                       return v.negate(smooth_minimum(v, v.negate(a[0]), v.negate(a[1]), a[2]));
                     }};
  f["sqrt"] = {"sqrt(x)", "square root; 0 below 0", 1, 1,
               [](V v, A a) { return of_number(v, Op::square_root, "sqrt", a[0], 0.0, {}); }};
  f["exp"] = {"exp(x)", "e^x; x is at most 80", 1, 1, [](V v, A a) { return exponential(v, a[0]); }};
  f["log"] = {"log(x)", "natural logarithm; of 1e-30 at least", 1, 1,
              [](V v, A a) { return of_number(v, Op::logarithm, "log", a[0], 1e-30, {}); }};
  f["pow"] = {"pow(x, n)", "x^n: of a vec3 the triplex power, of a quat the quaternion's", 2, 2,
              [](V v, A a) { return v.power(a[0], a[1], std::nullopt); }};
  f["sin"] = {"sin(x)", "sine; angles are in radians", 1, 1, [](V v, A a) { return sine(v, a[0]); }};
  f["cos"] = {"cos(x)", "cosine", 1, 1, [](V v, A a) { return cosine(v, a[0]); }};
  f["tan"] = {"tan(x)", "tangent", 1, 1, [](V v, A a) { return v.divide(sine(v, a[0]), cosine(v, a[0])); }};
  f["acos"] = {"acos(x)", "inverse cosine; x is kept within [-1, 1]", 1, 1,
               [](V v, A a) { return of_number(v, Op::arc_cosine, "acos", a[0], -1.0, 1.0); }};
  f["asin"] = {"asin(x)", "inverse sine; x is kept within [-1, 1]", 1, 1, [](V v, A a) {
                 return v.add(v.number(std::numbers::pi / 2),
                              of_number(v, Op::arc_cosine, "asin", a[0], -1.0, 1.0), true);
               }};
  f["atan"] = {"atan(y, x)", "angle of the point (x, y); atan(t) is atan(t, 1)", 1, 2, [](V v, A a) {
                 return v.each(Op::arc_tangent, scalar(a[0]), a.size() == 2 ? scalar(a[1]) : v.number(1));
               }};
  f["sinh"] = {"sinh(x)", "hyperbolic sine", 1, 1, [](V v, A a) { return hyperbolic(v, a[0], true); }};
  f["cosh"] = {"cosh(x)", "hyperbolic cosine", 1, 1, [](V v, A a) { return hyperbolic(v, a[0], false); }};
  f["tanh"] = {"tanh(x)", "hyperbolic tangent", 1, 1,
               [](V v, A a) { return v.divide(hyperbolic(v, a[0], true), hyperbolic(v, a[0], false)); }};
  f["radians"] = {"radians(x)", "degrees to radians", 1, 1,
                  [turn](V v, A a) { return v.multiply(scalar(a[0]), v.number(turn)); }};
  f["vec3"] = {"vec3(x, y, z)", "a point; vec3(x) has equal components", 1, 3, make_vec3};
  f["quat"] = {"quat(x, y, z, w)", "x + y i + z j + w k; also quat(v, w) of a vec3", 2, 4, make_quat};
  f["length"] = {"length(v)", "of a vec3 or quat; length(x, y) in the plane", 1, 2, length_of};
  f["dot"] = {"dot(a, b)", "inner product", 2, 2, [](V v, A a) { return v.dot(a[0], a[1]); }};
  f["cross"] = {"cross(a, b)", "vector product", 2, 2, [](V v, A a) { return v.cross(a[0], a[1]); }};
  f["normalize"] = {"normalize(v)", "v / |v|", 1, 1, [](V v, A a) { return v.divide(a[0], v.length(a[0])); }};
  f["distance"] = {"distance(a, b)", "|a - b|", 2, 2,
                   [](V v, A a) { return v.length(v.add(a[0], a[1], true)); }};
  f["conj"] = {"conj(q)", "conjugate quaternion", 1, 1, [](V v, A a) { return v.conjugate(a[0]); }};
  f["bicomplex"] = {"bicomplex(a, b)", "product of two quats as bicomplex numbers", 2, 2,
                    [](V v, A a) { return v.bicomplex_product(a[0], a[1]); }};
  f["fold"] = {"fold(v, n, d)",
               "reflect to the side of the plane n.v = d that n points to; d is 0 when left out", 2, 3,
               [](V v, A a) { return v.fold(a[0], a[1], a.size() == 3 ? a[2] : v.number(0)); }};
  f["boxfold"] = {"boxfold(v, l)", "reflect the components beyond [-l, l] at its ends", 2, 2,
                  [](V v, A a) { return v.box_fold(a[0], a[1]); }};
  f["ballfold"] = {"ballfold(v, r, R)", "invert in the ball of radius R, linear inside r", 3, 3,
                   [](V v, A a) { return v.ball_fold(a[0], a[1], a[2]); }};
  f["invert"] = {"invert(v, s)", "s v / |v|^2", 2, 2, [](V v, A a) { return v.invert(a[0], a[1]); }};
  f["wrap"] = {"wrap(v, m)", "repeat space with period m, centred on 0", 2, 2,
               [](V v, A a) { return v.wrap(a[0], a[1]); }};
  f["rotate"] = {"rotate(v, axis, angle)", "v turned about the axis by the angle", 3, 3,
                 [](V v, A a) { return v.rotate(a[0], a[1], a[2]); }};
  return f;
}

const std::map<std::string, Function>& functions() {
  static const std::map<std::string, Function> all = make_functions();
  return all;
}

}  // namespace

bool is_function(const std::string& name) { return functions().contains(name); }

Value call_function(Values& values, const std::string& name, const std::vector<Value>& arguments) {
  const auto found = functions().find(name);
  if (found == functions().end()) {
    std::vector<std::string> names;
    std::string known;
    for (const auto& [each, function] : functions()) {
      names.push_back(each);
      known += (known.empty() ? "there are " : ", ") + each;
    }
    throw std::invalid_argument("no function '" + name + "': " + did_you_mean(name, names, known, "'"));
  }
  const Function& f = found->second;
  require(arguments.size() >= f.least && arguments.size() <= f.most,
          "'" + name + "' is called as " + f.call + ", found " + std::to_string(arguments.size()) +
              (arguments.size() == 1 ? " argument" : " arguments"));
  return f.apply(values, arguments);
}

const std::vector<FunctionHelp>& function_help() {
  static const std::vector<FunctionHelp> help = [] {
    std::vector<FunctionHelp> all;
    for (const auto& [name, function] : functions()) all.push_back({function.call, function.meaning});
    return all;
  }();
  return help;
}

}  // namespace sundog
