// Signed distance fields as plain values: formulas, put together by constructive operations, in an interval.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/formula/definition.h"

namespace sundog {

/// One formula of a sequence: applied `times` iterations in a row, then comes the next one's turn.
struct FormulaStep {
  FormulaDefinition definition;
  std::vector<double> values;  // of its parameters, component after component
  int times = 1;               // 1..100
};

/// One formula or, when there are several steps, a hybrid: the first step's start, the last step's distance.
struct FormulaField {
  std::vector<FormulaStep> steps;
  int iterations = 8;  // over all steps
  double bailout = 16;
  double safety = 1;
};

/// A node of the tree. Its operands are `children`; smooth > 0 rounds a union, intersection or difference
/// over that length.
struct SdfNode {
  enum class Kind {
    formula,
    unite,
    intersect,
    subtract,   // two or more children; subtract: the first less all others
    transform,  // one child, moved: world_from_child = translate(offset) * rotation * scale
    repeat,   // one child in cells of `period` (0: not repeated along that axis), `count` cells to each side
              // (0: without end)
    thicken,  // one child's surface moved outwards by `amount`
    shell,    // one child's surface as a wall of thickness `amount`
    native    // OpenCL C of the user's own: no children
  } kind = Kind::formula;
  FormulaField formula;
  double smooth = 0;
  glm::dvec3 offset{0};
  glm::dmat3 rotation{1};
  double scale = 1;
  glm::dvec3 period{0}, count{0};
  double amount = 0;
  std::string code;  // native: body of a function of REAL3 p that returns a distance, as REAL
  std::vector<SdfNode> children;

  static constexpr int max_depth = 16, max_formulas = 64;
};

enum class SdfColorBy { none, point, plane, axis, iterations, radius };

/// Colours from the orbit: palette(fract(trap * scale + offset)), linear between the stops, the last joining
/// the first.
struct SdfColoring {
  SdfColorBy by = SdfColorBy::none;
  std::vector<glm::dvec3> palette;  // linear RGB, 1..64 stops
  double scale = 1, offset = 0;
};

struct SdfDescription {
  std::string name;
  SdfNode root;
  glm::dvec3 lower{-1.5}, upper{1.5};  // the interval in which it is built; cuts the surface
  std::optional<glm::dvec4> sphere;    // centre and radius of a cutting sphere
  // Surface threshold in pixel footprints; without it 0.05 for closed forms, whose hits are refined (their
  // silhouettes are as much too wide), and 0.5 for all others.
  std::optional<double> detail;
  double least = 1e-4, greatest = 0.1;  // limits of the threshold, in units of the field
  int step_limit = 512;                 // 16..65536
  SdfColoring coloring;
  double occlusion = 0;    // how far off the surface ambient light is looked for; 0: everywhere the same
  double soft_shadow = 0;  // hardness of its shadows: a penumbra is 1 / hardness of its length; 0: sharp
  glm::dvec3 glow{0};      // light gathered by rays that pass near it, linear RGB
  double glow_width = 0;   // distance at which the glow has fallen to 1 / e; 0: none
};

}  // namespace sundog
