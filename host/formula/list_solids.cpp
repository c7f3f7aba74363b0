// Solids and surfaces in closed form.
#include "formula/list_parts.h"

namespace sundog {
namespace {

constexpr const char* hart = "J. Hart, Sphere tracing, The Visual Computer 12, 1996";
constexpr const char* quilez = "I. Quilez, Distance functions (iquilezles.org/articles/distfunctions)";
constexpr const char* box_distance = "length(max(q, 0)) + min(max(max(q.x, q.y), q.z), 0)";

FormulaParameter length(const char* name, double value, const char* meaning = "", const char* old_name = "") {
  return {name, {value}, 0, 100, false, meaning, old_name};
}

FormulaParameter half_sizes(std::vector<double> value, double least, double most, const char* meaning) {
  return {"half", std::move(value), least, most, false, meaning, "size"};
}

FormulaDefinition solid(const char* name, const char* title, const char* source, const std::string& distance,
                        std::vector<FormulaParameter> parameters) {
  FormulaDefinition d;
  d.name = name;
  d.title = title;
  d.source = source;
  d.kind = FormulaKind::direct;
  d.distance = distance;
  d.parameters = std::move(parameters);
  d.smooth = true;
  d.bailout = 0;
  return d;
}

FormulaDefinition periodic(const char* name, const char* title, const char* field, double steepest) {
  FormulaDefinition d = solid(
      name, title, "A. Schoen, Infinite periodic minimal surfaces without self-intersections, NASA 1970",
      "k = 2 * pi / cell; x = k * p.x; y = k * p.y; z = k * p.z\n"
      "(abs(" +
          std::string(field) + ") / " + std::to_string(steepest) + ") / k - 0.5 * thickness",
      {{"cell", {1}, 0.05, 100, false, "period"}, length("thickness", 0.08, "of the wall")});
  return d;
}

FormulaDefinition torus_knot() {
  FormulaDefinition d =
      solid("torus_knot", "Torus knot (windings, turns) as a tube",
            "after I. Quilez, Distance functions; nearest strand in the plane through the axis",
            "u = length(p.x, p.z) - major_radius\n"
            "w = wrap(atan(p.y, u) - atan(p.z, p.x) * turns / windings, 2 * pi / windings)\n"
            "s = length(u, p.y)\n"
            "sqrt(s * s + minor_radius * minor_radius - 2 * s * minor_radius * cos(w)) - tube",
            {length("major_radius", 1, "", "major"),
             length("minor_radius", 0.4, "", "minor"),
             length("tube", 0.15),
             {"windings", {2}, 1, 16, true, "about the axis"},
             {"turns", {3}, 1, 16, true, "about the circle in it"}});
  d.safety = 0.45;
  d.bounds = {-1.6, -0.6, -1.6, 1.6, 0.6, 1.6};
  return d;
}

FormulaDefinition heart() {
  FormulaDefinition d =
      solid("heart", "Heart", "G. Taubin, Rasterizing algebraic curves and surfaces, IEEE CG&A 14, 1994",
            "q = p.x * p.x + 2.25 * p.z * p.z + p.y * p.y - 1\n"  // cube roots keep the gradient above 0
            "q - max(p.x * p.x + 0.1125 * p.z * p.z, 1e-6) ^ (1 / 3) * p.y",
            {});
  d.normalize = true;
  d.safety = 0.35;
  return d;
}

FormulaDefinition round_box(const FormulaParameter& half) {
  FormulaDefinition d =
      solid("round_box", "Box with rounded edges", quilez,
            "q = abs(p) - half + radius\n" + std::string(box_distance) + " - radius",
            {half, length("radius", 0.2, "of the edges, at most the least half size", "rounding")});
  d.old_name = "rounded_box";
  return d;
}

FormulaDefinition ellipsoid() {
  FormulaDefinition d = solid("ellipsoid", "Ellipsoid", quilez,
                              "r0 = length(p / half); g = length(p / (half * half))\nr0 < 1e-3 ? "
                              "-min(min(half.x, half.y), half.z) : r0 * (r0 - 1) / g",
                              {half_sizes({1, 0.6, 0.4}, 0.01, 100, "half axes")});
  d.safety = 0.8;
  return d;
}

}  // namespace

std::vector<FormulaDefinition> solid_formulas() {
  const FormulaParameter half = half_sizes({1, 1, 1}, 0.001, 100, "half sizes");
  return {
      solid("sphere", "Sphere", hart, "length(p) - radius", {length("radius", 1)}),
      solid("box", "Box", quilez, "q = abs(p) - half\n" + std::string(box_distance), {half}),
      round_box(half),
      solid("torus", "Torus about y", hart, "length(length(p.x, p.z) - major_radius, p.y) - minor_radius",
            {length("major_radius", 1, "", "major"), length("minor_radius", 0.3, "", "minor")}),
      solid("cylinder", "Cylinder about y", quilez,
            "a = length(p.x, p.z) - radius; b = abs(p.y) - half_height\nmin(max(a, b), 0) + length(max(a, "
            "0), max(b, 0))",
            {length("radius", 1), length("half_height", 1, "", "height")}),
      solid("capsule", "Capsule along y", quilez,
            "length(p - vec3(0, clamp(p.y, -half_height, half_height), 0)) - radius",
            {length("radius", 0.5), length("half_height", 0.7, "without the caps", "height")}),
      solid("octahedron", "Octahedron", quilez, "q = abs(p)\n(q.x + q.y + q.z - radius) / sqrt(3)",
            {length("radius", 1)}),
      ellipsoid(),
      periodic("gyroid", "Gyroid, a periodic minimal surface, as a wall",
               "(sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x))", 1.7320509),
      periodic("schwarz_p", "Schwarz P, a periodic minimal surface, as a wall", "(cos(x) + cos(y) + cos(z))",
               1.7320509),
      periodic("schwarz_d", "Schwarz D (diamond), a periodic minimal surface, as a wall",
               "(cos(x) * cos(y) * cos(z) - sin(x) * sin(y) * sin(z))", 1.25),
      torus_knot(),
      heart(),
      solid("blobs", "Three spheres in a smooth union", quilez,
            "a = length(p - vec3(-0.5, -0.2, 0)) - radius; b = length(p - vec3(0.5, -0.2, 0)) - radius\n"
            "d = length(p - vec3(0, 0.6, 0)) - radius\nsmooth_min(smooth_min(a, b, blend), d, blend)",
            {length("radius", 0.45), {"blend", {0.4}, 0, 10, false, "length over which they flow together"}}),
      solid("lattice", "Rounded boxes repeated through space", quilez,
            "q = abs(wrap(p, cell)) - half + radius\n" + std::string(box_distance) + " - radius",
            {{"cell", {1}, 0.01, 100, false, "period"},
             half_sizes({0.3, 0.3, 0.3}, 0.001, 50, "half sizes, less than half the cell"),
             length("radius", 0.05, "of the edges", "rounding")}),
  };
}

}  // namespace sundog
