// The derivatives that the formula language makes of a map, against those written by hand.
#include <cmath>
#include <random>

#include "catch.h"
#include "formula/evaluate.h"
#include "formula/list.h"
#include "formula/lower.h"

using namespace sundog;
namespace in = formula_input;

namespace {

/// Values of a lowered map's inputs at one point of an orbit.
struct State {
  std::vector<double> p{0, 0, 0}, z, c, parameters;
  double derivative = 1;
  std::vector<double> tangents = std::vector<double>(12, 0.0);

  double operator()(int index) const {
    if (index >= in::parameter) return parameters.at(static_cast<std::size_t>(index - in::parameter));
    if (index >= in::tangent_z) return tangents.at(static_cast<std::size_t>(index - in::tangent_z));
    if (index == in::derivative) return derivative;
    if (index == in::square) {
      double sum = 0;
      for (const double v : z) sum += v * v;
      return sum;
    }
    if (index >= in::c && index < in::c + 4) return c.at(static_cast<std::size_t>(index - in::c));
    if (index >= in::z && index < in::z + 4) return z.at(static_cast<std::size_t>(index - in::z));
    return index < 3 ? p.at(static_cast<std::size_t>(index)) : 0.0;
  }
};

std::vector<double> random_point(std::mt19937& random, std::size_t size) {
  std::uniform_real_distribution<double> uniform(-1.2, 1.2);
  std::vector<double> v(size);
  for (double& x : v) x = uniform(random);
  return v;
}

double length(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

FormulaDefinition map_of(const std::string& map) {
  FormulaDefinition d;
  d.map = map;
  return d;
}

/// White and Nylander's power by angles, as it is usually written.
std::vector<double> triplex_power(const std::vector<double>& z, double n) {
  const double r = length(z), t = n * std::acos(z[2] / r), f = n * std::atan2(z[1], z[0]),
               rn = std::pow(r, n);
  return {rn * std::sin(t) * std::cos(f), rn * std::sin(t) * std::sin(f), rn * std::cos(t)};
}

}  // namespace

TEST_CASE("the Mandelbulb's derivative is the hand-written n r^(n-1) dr + 1 to rounding, for every power") {
  std::mt19937 random(1);
  for (const double n : {2.0, 3.0, 5.0, 8.0, 9.0, 16.0, 2.5, 7.3}) {
    FormulaDefinition d = *find_formula("mandelbulb");
    d.derivative = FormulaDerivative::radial;
    const LoweredFormula f = lower(d, {n});
    REQUIRE_FALSE(f.jacobian);
    for (int i = 0; i < 200; ++i) {
      State s;
      s.z = random_point(random, 3);
      s.c = random_point(random, 3);
      s.derivative = 10.0 * std::uniform_real_distribution<double>(0, 1)(random);
      s.parameters = {n};
      const auto found = evaluate(f.map.graph, std::vector<NodeId>{f.map.derivative}, s)[0];
      const double wanted = n * std::pow(length(s.z), n - 1) * s.derivative + 1;
      CHECK(std::abs(found - wanted) <= 1e-13 * wanted);
    }
  }
}

TEST_CASE(
    "the Mandelbulb's running derivative is the norm of its map's, never less than any direction's growth") {
  std::mt19937 random(7);
  FormulaDefinition mandelbulb = *find_formula("mandelbulb");
  mandelbulb.derivative = FormulaDerivative::running;
  for (const double n : {2.0, 3.0, 8.0, 2.5}) {
    const LoweredFormula f = lower(mandelbulb, {n});
    REQUIRE_FALSE(f.jacobian);
    double tightest = 1e9;
    for (int i = 0; i < 300; ++i) {
      State s;
      s.z = random_point(random, 3);
      s.c = {0, 0, 0};
      s.parameters = {n};
      const double bound =
          evaluate(f.map.graph, std::vector<NodeId>{f.map.derivative}, s)[0] - 1;  // less c's
      const double t = std::acos(s.z[2] / length(s.z));
      const double wanted =
          n * std::pow(length(s.z), n - 1) * std::max(1.0, std::abs(std::sin(n * t) / std::sin(t)));
      CHECK(std::abs(bound - wanted) <= 1e-9 * (1 + wanted));
      const auto from = triplex_power(s.z, n);
      for (int k = 0; k < 20; ++k) {
        const auto step = random_point(random, 3);
        std::vector<double> moved = s.z;
        for (std::size_t j = 0; j < 3; ++j) moved[j] += 1e-7 * step[j];
        auto to = triplex_power(moved, n);
        for (std::size_t j = 0; j < 3; ++j) to[j] -= from[j];
        if (std::abs(std::atan2(moved[1], moved[0]) - std::atan2(s.z[1], s.z[0])) > 1)
          continue;  // across the cut
        CHECK(length(to) <= bound * 1e-7 * length(step) * (1 + 1e-4) + 1e-14);
        tightest = std::min(tightest, bound * 1e-7 * length(step) / length(to));
      }
    }
    CHECK(tightest < 1.02);
  }
}

TEST_CASE("the quaternion Julia set's derivative is the hand-written 2 |z| dr to rounding") {
  std::mt19937 random(2);
  const FormulaDefinition& d = *find_formula("julia");
  const auto values = default_values(d);
  const LoweredFormula f = lower(d, values);
  REQUIRE_FALSE(f.jacobian);
  for (int i = 0; i < 500; ++i) {
    State s;
    s.z = random_point(random, 4);
    s.c = random_point(random, 4);
    s.derivative = 7;
    s.parameters = values;
    const auto found = evaluate(f.map.graph, std::vector<NodeId>{f.map.derivative}, s)[0];
    CHECK(std::abs(found - 2 * length(s.z) * 7) <= 1e-13 * found);
  }
}

TEST_CASE("the algebraic powers are the trigonometric ones") {
  std::mt19937 random(3);
  for (int n = 1; n <= 16; ++n) {
    FormulaDefinition d = map_of("z = z ^ " + std::to_string(n) + " + c");
    const LoweredFormula f = lower(d, {});
    for (int i = 0; i < 100; ++i) {
      State s;
      s.z = random_point(random, 3);
      s.c = {0, 0, 0};
      const auto found = evaluate(f.map.graph, f.map.z, s);
      const auto wanted = triplex_power(s.z, n);
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(std::abs(found[k] - wanted[k]) <= 1e-10 * std::pow(length(s.z), n));
    }
  }
}

TEST_CASE("a quaternion's power is the repeated product") {
  FormulaDefinition power = map_of("z = z ^ 5"), product = map_of("z = z * z * z * z * z");
  power.quaternion = product.quaternion = true;
  const LoweredFormula f = lower(power, {}), g = lower(product, {});
  std::mt19937 random(4);
  for (int i = 0; i < 200; ++i) {
    State s;
    s.z = random_point(random, 4);
    s.c = {0, 0, 0, 0};
    const auto a = evaluate(f.map.graph, f.map.z, s), b = evaluate(g.map.graph, g.map.z, s);
    for (std::size_t k = 0; k < 4; ++k) CHECK(std::abs(a[k] - b[k]) <= 1e-12 * std::pow(length(s.z), 5));
    CHECK(evaluate(f.map.graph, std::vector<NodeId>{f.map.derivative}, s)[0] ==
          Approx(evaluate(g.map.graph, std::vector<NodeId>{g.map.derivative}, s)[0]).epsilon(1e-12));
  }
}

TEST_CASE("the exact derivative of every listed map agrees with finite differences") {
  std::mt19937 random(5);
  for (const FormulaDefinition& d : formula_list()) {
    if (d.kind == FormulaKind::direct) continue;
    const auto values = default_values(d);
    const LoweredFormula f = lower(d, values);
    const auto size = static_cast<std::size_t>(f.size);
    int disagreeing = 0;
    for (int i = 0; i < 200; ++i) {
      State s;
      s.parameters = values;
      s.z = random_point(random, size);
      s.c = random_point(random, size);
      for (std::size_t k = 0; k < 3; ++k) s.tangents[k * 3 + k] = 1;  // d z / d p = 1
      double worst = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double h = 1e-6;
        State ahead = s, behind = s;
        ahead.z[static_cast<std::size_t>(axis)] += h;
        behind.z[static_cast<std::size_t>(axis)] -= h;
        // c moves with p wherever the start makes it of p
        for (std::size_t k = 0; k < size; ++k) {
          const NodeId t = f.start.c_tangents[k][static_cast<std::size_t>(axis)];
          REQUIRE(f.start.graph.is_constant(t));
          ahead.c[k] += h * f.start.graph[t].value;
          behind.c[k] -= h * f.start.graph[t].value;
        }
        const auto y1 = evaluate(f.map.graph, f.map.z, ahead), y0 = evaluate(f.map.graph, f.map.z, behind);
        for (std::size_t k = 0; k < size; ++k) {
          const auto tangent = evaluate(
              f.map.graph, std::vector<NodeId>{f.map.z_tangents[k][static_cast<std::size_t>(axis)]}, s)[0];
          worst = std::max(worst, std::abs((y1[k] - y0[k]) / (2 * h) - tangent) / (1 + std::abs(tangent)));
        }
      }
      disagreeing += worst > 1e-4;
    }
    INFO(d.name);
    CHECK(disagreeing <= 2);  // a fold's crease may lie between the two points of a difference
  }
}

TEST_CASE("a map that tears space apart is differentiated exactly, one that keeps shapes is not") {
  CHECK_FALSE(lower(map_of("z = 3 * abs(z.zxy) - vec3(1, 2, 3)"), {}).jacobian);
  CHECK_FALSE(lower(map_of("t = boxfold(z, 1)\nz = 2 * ballfold(t, 0.5, 1) + c"), {}).jacobian);
  CHECK(lower(map_of("z = abs(z + 1) - abs(z - 1) - z"), {}).jacobian);
  CHECK(lower(map_of("z = vec3(z.x * z.x - z.y, sin(z.y), z.z) + c"), {}).jacobian);
  CHECK(lower(map_of("z.x = 2 * z.x"), {}).jacobian);
  CHECK(lower(map_of("z = max(z.x, vec3(-9, -9, -9)) + c"), {}).jacobian);  // longer by sqrt(3)
  CHECK(lower(map_of("z = wrap(z.x, vec3(9, 9, 9)) + c"), {}).jacobian);
  FormulaDefinition forced = map_of("z.x = 2 * z.x");
  forced.derivative = FormulaDerivative::running;
  CHECK_THROWS_AS(lower(forced, {}), FormulaError);
}

TEST_CASE("the running derivative bounds how far the map can take two points apart") {
  std::mt19937 random(6);
  for (const char* map : {"z = z ^ 2 + c", "z = 2 * ballfold(boxfold(z, 1), 0.5, 1) + c",
                          "z = 3 * fold(abs(z), vec3(1, -1, 0)) - vec3(2, 2, 2)",
                          "z = invert(wrap(z, 2), 1.2)", "z = rotate(z, vec3(1, 2, 3), 0.7) * 1.5"}) {
    FormulaDefinition d = map_of(map);
    if (std::string(map) == "z = z ^ 2 + c") d.quaternion = true;
    const LoweredFormula f = lower(d, {});
    REQUIRE_FALSE(f.jacobian);
    const auto size = static_cast<std::size_t>(f.size);
    for (int i = 0; i < 500; ++i) {
      State a;
      a.z = random_point(random, size);
      a.c = std::vector<double>(size, 0.25);
      State b = a;
      const double h = 1e-7;
      std::vector<double> step = random_point(random, size);
      for (std::size_t k = 0; k < size; ++k) b.z[k] += h * step[k];
      const auto ya = evaluate(f.map.graph, f.map.z, a), yb = evaluate(f.map.graph, f.map.z, b);
      double moved = 0;
      for (std::size_t k = 0; k < size; ++k) moved += (ya[k] - yb[k]) * (ya[k] - yb[k]);
      const double bound = evaluate(f.map.graph, std::vector<NodeId>{f.map.derivative}, a)[0];
      INFO(map);
      CHECK(std::sqrt(moved) <= bound * h * length(step) * (1 + 1e-5) + 1e-15);
    }
  }
}

TEST_CASE("the estimate falls to nothing at the surface on which the iterations' limit ends orbits") {
  for (const char* name : {"julia", "mandelbulb"}) {
    FormulaDefinition d = *find_formula(name);
    FormulaEvaluator field({{{d, default_values(d), 1}}, 4, 4, 1});
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.6, 0.4, 0.7));
    double inside = 0, outside = 2;
    while (outside - inside > 1e-12) {
      const double middle = 0.5 * (inside + outside);
      (field.at(way * middle).inside ? inside : outside) = middle;
    }
    INFO(name);
    CHECK(inside > 0.1);
    for (const double apart : {1e-6, 1e-4, 1e-3}) {
      const double found = field.at(way * (outside + apart)).distance;
      CHECK(found > 0.05 * apart);
      CHECK(found < 1.01 * apart);
    }
  }
}
