// Kaleidoscopic and inversive surfaces: space is repeatedly folded onto one part of the solid and scaled up.
#include <string>

#include "formula/list_parts.h"

namespace sundog {
namespace {

constexpr const char* knighty = "knighty, Kaleidoscopic (escape time) IFS, fractalforums.com, 2010";

FormulaDefinition folded(const char* name, const char* title, const char* source, const std::string& map,
                         const std::string& distance) {
  FormulaDefinition d;
  d.name = name;
  d.title = title;
  d.source = source;
  d.kind = FormulaKind::folded;
  d.map = map;
  d.distance = distance;
  d.bailout = 1000;
  d.bounds = {-1.05, -1.05, -1.05, 1.05, 1.05, 1.05};
  return d;
}

std::vector<FormulaParameter> scale_and_offset(double scale, std::vector<double> offset) {
  return {{"scale", {scale}, 1.1, 6, false, "of one step"},
          {"offset", std::move(offset), -2, 2, false, "the point that a step leaves in its place"},
          {"axis", {0, 0, 1}, -1, 1, false, "of a turn in every step; not zero"},
          {"angle", {0}, -180, 180, false, "of that turn, in degrees"}};
}

constexpr const char* sort_map =
    "z = abs(z)\n"
    "z = fold(z, vec3(1, -1, 0)); z = fold(z, vec3(1, 0, -1)); z = fold(z, vec3(0, 1, -1))\n";

FormulaDefinition menger() {
  const std::string map = std::string(sort_map) +
                          "z = rotate(z, axis, radians(angle))\n"
                          "z = scale * z - (scale - 1) * offset\n"
                          "z = fold(z, vec3(0, 0, 1), -0.5 * (scale - 1) * offset.z)";
  FormulaDefinition d =
      folded("menger", "Menger sponge", "K. Menger, 1926; as folds by knighty, fractalforums.com, 2010", map,
             "q = abs(z) - 1\nlength(max(q, 0)) + min(max(max(q.x, q.y), q.z), 0)");
  d.parameters = scale_and_offset(3, {1, 1, 1});
  d.iterations = 5;
  return d;
}

FormulaDefinition sierpinski() {
  FormulaDefinition d = folded(
      "sierpinski", "Sierpinski tetrahedron", knighty,
      "z = fold(z, vec3(1, 1, 0)); z = fold(z, vec3(1, 0, 1)); z = fold(z, vec3(0, 1, 1))\n"
      "z = rotate(z, axis, radians(angle))\n"
      "z = scale * z - (scale - 1) * offset",
      "(max(max(-z.x - z.y - z.z, z.x + z.y - z.z), max(z.y + z.z - z.x, z.x + z.z - z.y)) - 1) / sqrt(3)");
  d.parameters = scale_and_offset(2, {1, 1, 1});
  d.iterations = 9;
  return d;
}

FormulaDefinition octahedron_flake() {
  const std::string map =
      std::string(sort_map) + "z = rotate(z, axis, radians(angle))\nz = scale * z - (scale - 1) * offset";
  FormulaDefinition d = folded("octahedron_flake", "Octahedral kaleidoscopic IFS", knighty, map,
                               "q = abs(z)\n(q.x + q.y + q.z - 1) / sqrt(3)");
  d.parameters = scale_and_offset(2, {1, 0, 0});
  d.iterations = 8;
  return d;
}

// Reflections across the coordinate planes and another mirror, three times: every point ends up in one of the
// 120 chambers of the icosahedral group (checked by test_formula_list.cpp).
constexpr const char* icosahedral_folds =
    "n = vec3(-0.80901699437, -0.5, 0.30901699437)\n"
    "z = fold(abs(z), n); z = fold(abs(z), n); z = fold(abs(z), n)\n";
constexpr const char* icosahedral_distance =
    "n = vec3(-0.80901699437, -0.5, 0.30901699437)\n"
    "f = fold(abs(fold(abs(fold(abs(z), n)), n)), n)\n";

FormulaDefinition icosahedral(const char* name, const char* title, double scale, std::vector<double> offset,
                              const char* face) {
  const std::string map = std::string(icosahedral_folds) +
                          "z = rotate(z, axis, radians(angle))\nz = scale * z - (scale - 1) * offset";
  const std::string distance = std::string(icosahedral_distance) + "dot(f, " + face + ") - 0.7946544723";
  FormulaDefinition d = folded(name, title, knighty, map, distance);
  d.parameters = scale_and_offset(scale, std::move(offset));
  d.iterations = 6;
  return d;
}

FormulaDefinition icosahedron_flake() {
  return icosahedral("icosahedron_flake", "Icosahedral kaleidoscopic IFS", 2.61803398875,
                     {0, 0.5257311121, 0.8506508084}, "vec3(0.3568220898, 0, 0.9341723590)");
}
FormulaDefinition dodecahedron_flake() {
  return icosahedral("dodecahedron_flake", "Dodecahedral kaleidoscopic IFS", 3.61803398875,
                     {0.3568220898, 0, 0.9341723590}, "vec3(0, 0.5257311121, 0.8506508084)");
}

FormulaDefinition koch() {
  FormulaDefinition d =
      folded("koch", "Koch-like surface: a cube on the middle ninth of every square",
             "after H. von Koch, 1904; quadratic type 1 in three dimensions, as folds", "", "z.y");
  // Fold floor, wall and top of the cube onto the floor across the bisecting planes.
  d.map =
      "z = fold(z, vec3(1, 0, 0)); z = fold(z, vec3(0, 0, 1)); z = fold(z, vec3(1, 0, -1))\n"
      "z = fold(z, vec3(1, -1, 0), -0.23570226)\n"  // the top onto the wall, at the edge (1/3, 2/3)
      "z = fold(z, vec3(1, -1, 0), 0.23570226)\n"   // the wall onto the floor, at the edge (1/3, 0)
      "z = z - vec3(2 / 3, 0, 0)\n"
      "z = fold(z, vec3(0, 0, -1), -1 / 3)\n"
      "z = 3 * z";
  d.iterations = 5;
  d.bailout = 0;
  d.bounds = {-1, -0.3, -1, 1, 1.05, 1};
  return d;
}

FormulaDefinition apollonian() {
  FormulaDefinition d =
      folded("apollonian", "Apollonian gasket of spheres, by inversions in a periodic lattice",
             "I. Quilez, Apollonian (shadertoy.com/view/4ds3zn), 2013", "z = invert(wrap(z, 2), scale)",
             "0.25 * abs(z.y) - thickness");
  d.parameters = {
      {"scale", {1.2}, 0.8, 2, false, "squared radius of the inversion"},
      {"thickness", {0.005}, 0, 0.2, false, "half thickness of the sheets, before they are scaled"}};
  d.bailout = 0;
  d.bounds = {-1, -1, -1, 1, 1, 1};
  return d;
}

FormulaDefinition pseudo_kleinian() {
  FormulaDefinition d = folded("pseudo_kleinian", "Pseudo-Kleinian: box folds and inversions",
                               "Theli-at, after J. Hart and T. Lowe's folds; fractalforums.com, 2011",
                               "z = ballfold(boxfold(z, size), 0.01, radius)", "0.5 * abs(z.z) - thickness");
  d.parameters = {
      {"size", {0.92436, 0.90756, 0.92436}, 0.1, 4, false, "of the box fold"},
      {"radius", {1}, 0.1, 4, false, "of the inversion"},
      {"thickness", {0.01}, 0, 0.2, false, "half thickness of the sheets, before they are scaled"}};
  d.bailout = 0;
  d.safety = 0.6;
  d.bounds = {-1.5, -1.5, -1.5, 1.5, 1.5, 1.5};
  return d;
}

}  // namespace

std::vector<FormulaDefinition> folded_formulas() {
  return {menger(), sierpinski(), octahedron_flake(), icosahedron_flake(), dodecahedron_flake(),
          koch(),   apollonian(), pseudo_kleinian()};
}

}  // namespace sundog
