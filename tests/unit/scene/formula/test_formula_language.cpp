// The formula language: what it accepts, and the errors it gives for what it does not, with their places.
#include <cmath>

#include "catch.h"
#include "formula/list.h"
#include "formula/lower.h"
#include "formula/syntax.h"

using namespace sundog;

namespace {

/// Value of a distance expression at (0.5, -2, 3).
double value_of(const std::string& text, const std::vector<FormulaParameter>& parameters = {}) {
  FormulaDefinition d;
  d.kind = FormulaKind::direct;
  d.distance = text;
  d.parameters = parameters;
  const auto values = default_values(d);
  const LoweredFormula f = lower(d, values);
  const double p[3] = {0.5, -2, 3};
  return evaluate(f.finish.graph, std::vector<NodeId>{f.finish.distance}, [&](int index) {
    return index >= formula_input::parameter
               ? values.at(static_cast<std::size_t>(index - formula_input::parameter))
               : p[index];
  })[0];
}

struct Failure {
  int line = -1, column = -1;
  std::string what, section;
};
Failure failure_of_map(const std::string& map, std::vector<FormulaParameter> parameters = {}) {
  FormulaDefinition d;
  d.map = map;
  d.parameters = std::move(parameters);
  try {
    lower(d, default_values(d));
  } catch (const FormulaError& error) {
    return {error.line, error.column, error.what(), error.section};
  }
  return {};
}

void check_failure(const std::string& map, int line, int column, const std::string& part) {
  const Failure f = failure_of_map(map);
  INFO(map.substr(0, 80));
  CHECK(f.line == line);
  CHECK(f.column == column);
  CHECK(f.what.find(part) != std::string::npos);
  INFO(f.what);
  CHECK(f.section == "map");
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

}  // namespace

TEST_CASE("operators bind as in mathematics") {
  CHECK(value_of("2 + 3 * 4") == 14);
  CHECK(value_of("2 ^ 3 ^ 2") == 512);
  CHECK(value_of("-2 ^ 2") == -4);
  CHECK(value_of("2 ^ -1") == 0.5);
  CHECK(value_of("10 - 3 - 2") == 5);
  CHECK(value_of("8 / 4 / 2") == 1);
  CHECK(value_of("p.x < 1 && p.y < -3 ? 1 : p.z > 2 || p.x > 9 ? 2 : 3") == 2);
  CHECK(value_of("!(p.x < 0) ? 1 : 2") == 1);
  CHECK(value_of("(p.x > 0 ? p.y > 0 : p.z > 0) ? 1 : 2") == 2);
  CHECK(value_of("(p.x < 0 ? p.y > 0 : p.z > 0) ? 1 : 2") == 1);
  CHECK(value_of("p.y ^ 17 + pow(p.y, 20)") == 1048576 - 131072);
  CHECK(value_of("dot(p.zxy, vec3(1, 10, 100))") == 3 + 5 - 200);
}

TEST_CASE("functions give their values") {
  CHECK(value_of("length(p)") == Approx(std::sqrt(0.25 + 4 + 9)));
  CHECK(value_of("mod(p.y, 0.75)") == Approx(0.25));
  CHECK(value_of("sin(p.x) + cos(p.y) * tan(p.z)") == Approx(std::sin(0.5) + std::cos(2.0) * std::tan(3.0)));
  CHECK(value_of("asin(p.x) - acos(p.x) + atan(p.y, p.z)") ==
        Approx(std::asin(0.5) - std::acos(0.5) + std::atan2(-2.0, 3.0)));
  CHECK(value_of("sinh(p.x) + cosh(p.x) + tanh(p.x)") ==
        Approx(std::sinh(0.5) + std::cosh(0.5) + std::tanh(0.5)));
  CHECK(value_of("pow(p.z, 2.5) + exp(p.y) + log(p.z)") ==
        Approx(std::pow(3, 2.5) + std::exp(-2.0) + std::log(3.0)));
  CHECK(value_of("q = rotate(p, vec3(0, 0, 2), radians(90)); q.x") == Approx(2));
  CHECK(value_of("q = fold(p, vec3(0, 1, 0)); q.y") == Approx(2));
  CHECK(value_of("q = fold(p, vec3(1, 1, 0)); q.x * 10 + q.y") == Approx(2 * 10 - 0.5));
  CHECK(value_of("q = boxfold(p, 1); q.x * 100 + q.y * 10 + q.z") == Approx(50 + 0 - 1));
  CHECK(value_of("q = wrap(p, 2); q.x * 100 + q.y * 10 + q.z") == Approx(50 + 0 - 1));
  CHECK(value_of("q = wrap(quat(3, 3, -3, 3.5), 2); q.x * 1000 + q.y * 100 + q.z * 10 + q.w") ==
        Approx(-1000 - 100 - 10 - 0.5));
  CHECK(value_of("q = quat(1, 2, 3, 4) * quat(5, 6, 7, 8); q.x * 1000 + q.y * 100 + q.z * 10 + q.w") ==
        Approx(-60000 + 1200 + 300 + 24));
  CHECK(value_of("smooth_min(1, 1, 0.4)") == Approx(0.9));
  CHECK(value_of("smooth_min(1, 2, 0.4)") == Approx(1));
}

TEST_CASE("division by what may be zero is kept finite") {
  CHECK(std::isfinite(value_of("1 / (p.x - 0.5)")));
  CHECK(std::isfinite(value_of("log(p.x - 0.5) + sqrt(p.y) + acos(p.z)")));
  CHECK(std::isfinite(value_of("q = p - vec3(0.5, -2, 3); length(normalize(q))")));
}

TEST_CASE("a place in the text is given by line and column") {
  check_failure("z = z + q", 1, 9, "unknown name 'q': there are ");
  check_failure("t = 1\nz = z * (c +\n  y)", 3, 3, "unknown name 'y'");
  check_failure("z = z + ", 1, 9, "expected a value, found the statement's end");
  check_failure("z = (z + c", 1, 11, "expected ')'");
  check_failure("z = z $ c", 1, 7, "unexpected character '$'");
  check_failure("z = 2z", 1, 6, "cannot end in a letter");
  check_failure("z = z + vec3(1, 2)", 1, 9, "vec3 takes three numbers");
  check_failure("z = z < c ? z : c", 1, 7, "only numbers can be compared");
  check_failure("z = z.x", 1, 6, "'z' is a vec3, found a number");
  check_failure("z = z + c.w", 1, 10, "no component 'w'");
  check_failure("z = foo(z)", 1, 5, "no function 'foo': there are abs");
  check_failure("z = lenght(z)", 1, 5, "no function 'lenght': did you mean 'length'?");
  check_failure("total = 1\nz = z * totl", 2, 9, "unknown name 'totl': did you mean 'total'?");
  check_failure("z = abs(z, z)", 1, 5, "called as abs(x)");
  check_failure("c = z", 1, 1, "'c' cannot be set");
  check_failure("z = abs", 1, 5, "is a function");
  check_failure("z z = 1", 1, 3, "expected '='");
  check_failure("float d = length(z)", 1, 1, "variables are named without their type");
  check_failure("for (i = 0; i < 3; i = i + 1) z = z * z", 1, 1, "no text has loops");
  check_failure("if (z.x > 0) z = -z", 1, 1, "a ? b : c chooses a value");
  check_failure("z = if (z.x > 0) z", 1, 5, "a ? b : c chooses a value");
  check_failure("z += c", 1, 3, "found '+=': write z = z + ...");
  check_failure("z.x += 1", 1, 5, "write z.x = z.x + ...");
  check_failure("z = z ** 2 + c", 1, 8, "powers are written a ^ n");
  check_failure("z = z.x > 0 and z.y > 0 ? z : c", 1, 13, "write &&");
  check_failure("z = z * (i % 2)", 1, 12, "the rest of a division is mod(x, m)");
  check_failure("y.x = 1", 1, 1, "no value yet");
  check_failure("t = z + c", 1, 1, "must set z");
  check_failure("", 1, 1, "must set z");
}

TEST_CASE("a hostile formula gives its error and nothing else") {
  check_failure("z = " + repeated("(", 1000) + "z" + repeated(")", 1000), 1, 5 + FormulaLimits::nesting / 2,
                "nested deeper");
  check_failure("z = " + repeated("-", 1000) + "z", 1, 4 + FormulaLimits::nesting, "nested deeper");
  CHECK(failure_of_map("z = z" + repeated(" + c", 1000)).what.find("too long") != std::string::npos);
  CHECK(failure_of_map("z = z" + repeated(".xyz", 1000)).what.find("too long") != std::string::npos);
  CHECK(failure_of_map(repeated("z = z + c + c\n", 5000)).what.find("8192 characters") != std::string::npos);
  CHECK(failure_of_map(repeated("z = z + c\n", 300)).what.find("200 statements") != std::string::npos);
  CHECK(failure_of_map("z = z + " + repeated("a", 100)).what.find("32 characters") != std::string::npos);
  check_failure("#include \"secret.h\"\nz = z", 1, 1, "includes nothing");
  check_failure("z = z\n#pragma OPENCL", 2, 1, "no directives");
  check_failure("kernel = 1", 1, 1, "'kernel' is a reserved word; choose another name");
  check_failure("__global = 1", 1, 1, "reserved word");
  check_failure("float16 = 1", 1, 1, "reserved word");
  check_failure("z = z + barrier(1)", 1, 9, "no function 'barrier'");
  check_failure("z = z; } __kernel void x() {", 1, 8, "only round brackets");
  check_failure("z = z + \"text\"", 1, 9, "unexpected character");
  check_failure("z = z + c / 0", 1, 11, "division by zero");
  check_failure("z = z + c / (2 - 1 - 1)", 1, 11, "division by zero");
  check_failure("z = z + sqrt(-1)", 1, 9, "not defined at -1");
  check_failure("z = z + log(0)", 1, 9, "not defined at 0");
  check_failure("z = z + 1e31", 1, 9, "between -1e30 and 1e30");
  check_failure("z = z + c / (1e-30 * 1e-30)", 1, 11, "division by zero");  // in a device's floats
  check_failure("z = z * (1e30 * 1e30)", 1, 15, "not a finite number of at most 3.4e38");
  check_failure("z = z + \xc3\xa9", 1, 9, "unexpected character '\xc3\xa9': formulas are written in ASCII");
  check_failure("z = z \u2212 c", 1, 7, "unexpected character '\u2212': formulas are written in ASCII");
  check_failure(std::string("z = z\0+ c", 9), 1, 6, "unexpected character");
  std::string doubling = "t = z.x\n";  // 2^190 terms, if sharing were lost
  for (int i = 0; i < 190; ++i) doubling += "t = t*t + t\n";
  CHECK(failure_of_map(doubling + "z = z * t").line == -1);
  CHECK(failure_of_map(repeated("z=(z+c)^15;z=(z+p)^13.5;z=rotate(z,c,r);", 60)).what.find("too long") !=
        std::string::npos);
}

TEST_CASE("parameters are numbers, vec3s or quats, and cannot be set") {
  CHECK(value_of("a.y + b", {{"a", {1, 2, 3}}, {"b", {10}}}) == 12);
  CHECK(value_of("length(q)", {{"q", {1, 1, 1, 1}}}) == Approx(2));
  CHECK(failure_of_map("a = 1; z = z", {{"a", {1}}}).what == "'a' cannot be set");
}

TEST_CASE("a whole exponent is compiled in, another one is not") {
  FormulaDefinition d;
  d.map = "z = z ^ n + c";
  d.parameters = {{"n", {8}}};
  const auto uses_power = [&](double n) {
    const LoweredFormula f = lower(d, {n});
    for (NodeId id = 0; id < f.map.graph.size(); ++id)
      if (f.map.graph[id].op == Op::power || f.map.graph[id].op == Op::arc_tangent) return true;
    return false;
  };
  CHECK_FALSE(uses_power(8));
  CHECK(uses_power(8.5));
  CHECK(uses_power(17));
}

TEST_CASE("the list has its surfaces, each with a source and parameters within their ranges") {
  CHECK(formula_list().size() >= 20);
  for (const char* name : {"mandelbulb",
                           "julia",
                           "mandelbox",
                           "menger",
                           "sierpinski",
                           "octahedron_flake",
                           "icosahedron_flake",
                           "apollonian",
                           "pseudo_kleinian",
                           "koch",
                           "bicomplex",
                           "tricorn",
                           "amazing_surf",
                           "gyroid",
                           "torus_knot",
                           "round_box",
                           "rounded_box",  // as it was called
                           "blobs",
                           "lattice",
                           "sphere",
                           "box",
                           "torus"})
    CHECK(find_formula(name) != nullptr);
  CHECK(find_formula("no_such") == nullptr);
  const std::string text = formula_list_text();
  for (const FormulaDefinition& d : formula_list()) {
    INFO(d.name);
    CHECK_FALSE(d.title.empty());
    CHECK_FALSE(d.source.empty());
    CHECK_NOTHROW(lower(d, default_values(d)));
    CHECK(text.find("\n" + d.name + "\n") + 1 + text.starts_with(d.name + "\n") > 0);
    for (const FormulaParameter& p : d.parameters) {
      CHECK((p.value.size() == 1 || p.value.size() == 3 || p.value.size() == 4));
      for (const double v : p.value) CHECK((v >= p.minimum && v <= p.maximum));
      CHECK_FALSE(is_reserved_word(p.name));
      CHECK(text.find("    " + p.name + " = ") != std::string::npos);
    }
  }
}

TEST_CASE("the icosahedral folds take every point into one of the 120 chambers") {
  FormulaDefinition d = *find_formula("icosahedron_flake");
  d.map = d.map.substr(0, d.map.find("z = rotate"));
  d.parameters.clear();
  const LoweredFormula f = lower(d, {});
  const double phi = (1 + std::sqrt(5.0)) / 2;
  std::vector<std::array<double, 3>> mirrors{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const double a : {0.5, -0.5})
    for (const double b : {0.5, -0.5})
      for (std::size_t turn = 0; turn < 3; ++turn) {
        const std::array<double, 3> m{phi / 2, a, b * (phi - 1)};
        mirrors.push_back({m[turn % 3], m[(turn + 1) % 3], m[(turn + 2) % 3]});
      }
  std::vector<bool> chamber;
  unsigned seed = 1;
  const auto uniform = [&] {
    return static_cast<double>((seed = seed * 1664525u + 1013904223u) >> 8) / (1 << 23) - 1.0;
  };
  for (int i = 0; i < 2000; ++i) {
    const double z[3] = {uniform(), uniform(), uniform()};
    const auto folded = evaluate(f.map.graph, f.map.z, [&](int index) {
      return index >= formula_input::z && index < formula_input::z + 3 ? z[index - formula_input::z] : 0.0;
    });
    std::vector<bool> sides;
    for (const auto& m : mirrors) sides.push_back(m[0] * folded[0] + m[1] * folded[1] + m[2] * folded[2] > 0);
    if (chamber.empty()) chamber = sides;
    CHECK(sides == chamber);
  }
}
