// Escape-time surfaces: boundaries of the sets of points with bounded orbits.
#include "formula/list_parts.h"

namespace sundog {
namespace {

FormulaParameter power(double value,
                       const char* meaning = "exponent; whole ones are made of products alone") {
  return {"power", {value}, 1.5, 16, false, meaning};
}
const FormulaParameter slice{"slice", {0}, -2, 2, false, "fourth coordinate of the space that is looked at"};

FormulaDefinition powers(const char* name, const char* title, const char* source, const char* map,
                         double exponent) {
  FormulaDefinition d;
  d.name = name;
  d.title = title;
  d.source = source;
  d.map = map;
  d.parameters = {power(exponent)};
  d.iterations = 16;
  return d;
}

FormulaDefinition triplex(const char* name, const char* title, const char* source, const char* map,
                          double exponent) {
  FormulaDefinition d = powers(name, title, source, map, exponent);
  d.derivative = FormulaDerivative::radial;  // as usually shown; the proven bound looks rough
  d.exceptions = 0.01;
  return d;
}

FormulaDefinition mandelbulb() {
  FormulaDefinition d =
      triplex("mandelbulb", "Mandelbulb: z^n + c with the triplex power",
              "D. White and P. Nylander, 2009 (skytopia.com/project/fractal/mandelbulb.html)",
              "z = z ^ power + c", 8);
  d.bounds = {-1.25, -1.25, -1.25, 1.25, 1.25, 1.25};
  return d;
}

FormulaDefinition juliabulb() {
  FormulaDefinition d = triplex("juliabulb", "Julia set of the Mandelbulb's map, for one constant",
                                "after D. White and P. Nylander, 2009", "z = z ^ power + c", 8);
  d.start = "c = seed";
  d.parameters.push_back({"seed", {0.35, 0.6, -0.3}, -2, 2, false, "c"});
  return d;
}

FormulaDefinition julia() {
  FormulaDefinition d = powers(
      "julia", "Quaternion Julia set",
      "A. Norton, Generation and display of geometric fractals in 3-D, SIGGRAPH 1982; J. Hart, D. Sandin and "
      "L. Kauffman, Ray tracing deterministic 3-D fractals, SIGGRAPH 1989",
      "z = z ^ power + c", 2);
  d.quaternion = true;
  d.start = "z = quat(p, slice); c = seed";
  d.parameters.push_back({"seed", {-0.2, 0.8, 0, 0}, -2, 2, false, "c = x + y i + z j + w k"});
  d.parameters.push_back(slice);
  d.iterations = 100;
  return d;
}

FormulaDefinition quaternion_mandelbrot() {
  FormulaDefinition d =
      powers("quaternion_mandelbrot", "Mandelbrot set of the quaternions",
             "A. Norton, Generation and display of geometric fractals in 3-D, SIGGRAPH 1982",
             "z = z ^ power + c", 2);
  d.quaternion = true;
  d.start = "z = quat(p, slice)";
  d.parameters.push_back(slice);
  d.iterations = 100;
  d.bounds = {-2.1, -1.5, -1.5, 1.2, 1.5, 1.5};
  return d;
}

FormulaDefinition tricorn() {
  FormulaDefinition d =
      triplex("tricorn", "Tricorn bulb: the conjugate's triplex power",
              "after W. Crowe et al., On the structure of the Mandelbar set, Nonlinearity 2, 1989",
              "z = (z * vec3(1, -1, 1)) ^ power + c", 2);
  d.iterations = 24;
  d.bounds = {-2.2, -2.2, -2.2, 2.2, 2.2, 2.2};
  return d;
}

FormulaDefinition burning_ship() {
  FormulaDefinition d =
      triplex("burning_ship", "Burning Ship bulb: absolute values before the triplex power",
              "after M. Michelitsch and O. Roessler, The Burning Ship and its quasi-Julia sets, 1992",
              "z = abs(z) ^ power + c", 2);
  d.iterations = 24;
  d.bounds = {-2.2, -2.2, -2.2, 2.2, 2.2, 2.2};
  return d;
}

FormulaDefinition bicomplex() {
  FormulaDefinition d =
      powers("bicomplex", "Tetrabrot: Mandelbrot set of the bicomplex numbers",
             "D. Rochon, A generalized Mandelbrot set for bicomplex numbers, Fractals 8, 2000",
             "z = bicomplex(z, z) + c", 2);
  d.quaternion = true;
  d.start = "z = quat(p, slice)";
  d.parameters = {slice};
  d.iterations = 100;
  d.bounds = {-2.1, -1.5, -1.5, 1.2, 1.5, 1.5};
  return d;
}

FormulaDefinition mandelbox() {
  FormulaDefinition d;
  d.name = "mandelbox";
  d.title = "Mandelbox: box fold, ball fold, scale";
  d.source = "T. Lowe, 2010 (sites.google.com/site/mandelbox)";
  d.map = "z = scale * ballfold(boxfold(z, fold_limit), least_radius, fixed_radius) + c";
  d.estimate = EscapeEstimate::linear;
  d.parameters = {{"scale", {2}, -4, 4, false, "not in (-1, 1)"},
                  {"fold_limit", {1}, 0.1, 4, false, "half size of the box fold"},
                  {"least_radius", {0.5}, 0.01, 4, false, "of the ball fold: linear inside"},
                  {"fixed_radius", {1}, 0.01, 4, false, "of the ball fold: inversion inside"}};
  d.iterations = 32;
  d.bailout = 1000;
  d.safety = 0.95;
  d.inside_radius = 1000;
  d.inside_safety = 1;
  d.bounds = {-6.1, -6.1, -6.1, 6.1, 6.1, 6.1};
  return d;
}

FormulaDefinition amazing_surf() {
  FormulaDefinition d;
  d.name = "amazing_surf";
  d.title = "Amazing Surf: a Mandelbox that folds two axes alone, with a turn";
  d.source = "Kali and L. Buffoni (DarkBeam), fractalforums.org, about 2012";
  d.map =
      "z = boxfold(z, vec3(fold_x, fold_y, 1e6))\n"
      "z = scale * ballfold(z, least_radius, fixed_radius) + c\n"
      "z = rotate(z, axis, radians(angle))";
  d.estimate = EscapeEstimate::linear;
  d.exceptions = 0.01;  // |z| / dr ignores the size of the set itself
  d.parameters = {
      {"scale", {1.5}, -4, 4, false, ""},          {"fold_x", {1}, 0.1, 4, false, ""},
      {"fold_y", {1}, 0.1, 4, false, ""},          {"least_radius", {0.5}, 0.01, 4, false, ""},
      {"fixed_radius", {1}, 0.01, 4, false, ""},   {"axis", {1, 0, 0}, -1, 1, false, "of the turn; not zero"},
      {"angle", {30}, -180, 180, false, "degrees"}};
  d.iterations = 32;
  d.bailout = 1000;
  d.inside_radius = 1000;
  d.inside_safety = 1;
  d.bounds = {-4, -4, -4, 4, 4, 4};
  return d;
}

}  // namespace

std::vector<FormulaDefinition> escape_formulas() {
  return {mandelbulb(),   juliabulb(), julia(),     quaternion_mandelbrot(), tricorn(),
          burning_ship(), bicomplex(), mandelbox(), amazing_surf()};
}

}  // namespace sundog
