// Signed distance fields as plain values: formulas combined by constructive operations, in an interval.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formula/definition.h"

namespace sundog {

/// A formula in a sequence: applied `times` iterations in a row before the next one.
struct FormulaStep {
  FormulaDefinition definition;
  std::vector<double> values;  // its parameters' components in order
  int times = 1;               // 1..100
};

/// A formula, or a hybrid of several steps: the first step's start and the last step's distance.
struct FormulaField {
  std::vector<FormulaStep> steps;
  int iterations = 8;  // over all steps
  double bailout = 16;
  double safety = 1;
};

/// A tree node with operands `children`; smooth > 0 rounds a union, intersection or difference over that
/// length.
struct SdfNode {
  enum class Kind {
    formula,
    unite,
    intersect,
    subtract,   // two or more children; subtract: the first minus all others
    transform,  // one child: world_from_child = translate(offset) * rotation * scale
    repeat,   // one child in cells of `period` (0: not repeated along that axis), `count` cells to each side
              // (0: infinitely many)
    thicken,  // one child, its surface offset outwards by `amount`
    shell,    // one child, hollowed to a wall of thickness `amount`
    native    // user's OpenCL C: no children
  } kind = Kind::formula;
  FormulaField formula;
  double smooth = 0;
  glm::dvec3 offset{0};
  glm::dmat3 rotation{1};
  double scale = 1;
  glm::dvec3 period{0}, count{0};
  double amount = 0;
  std::string code;  // native: function body of REAL3 p that returns a REAL distance
  std::vector<SdfNode> children;

  static constexpr int max_depth = 16, max_formulas = 64;
};

enum class SdfColorBy { point, plane, axis, iterations, radius };

/// Colours from the orbit: palette(fract(trap * scale + offset)), linear between the stops, cyclic.
struct SdfColoring {
  SdfColorBy by = SdfColorBy::point;
  std::vector<glm::dvec3> palette;  // linear RGB, 1..64 stops
  double scale = 1, offset = 0;
};

struct SdfDescription {
  std::string name;
  SdfNode root;
  glm::dvec3 lower{-1.5}, upper{1.5};  // bounding interval; cuts the surface
  std::optional<glm::dvec4> sphere;    // centre and radius of a cutting sphere
  // Surface threshold in pixel footprints; default 0.05 for closed forms, whose hits are refined (the
  // threshold widens silhouettes), 0.5 otherwise.
  std::optional<double> detail;
  double least = 1e-4, greatest = 0.1;  // limits of the threshold, in units of the field
  int step_limit = 512;                 // 16..65536
  SdfColoring coloring;
  double occlusion = 0;    // search distance of ambient occlusion; 0: none
  double soft_shadow = 0;  // hardness of shadows: penumbra width / distance is 1 / hardness; 0: sharp
  glm::dvec3 glow{0};      // light gathered by rays that pass nearby, linear RGB
  double glow_width = 0;   // distance at which the glow falls to 1 / e; 0: none
};

}  // namespace sundog
