// One formula, or hybrid of formulas, as three OpenCL C functions: distance, two-sided distance, and sample
// (distance, gradient, orbit traps).
#pragma once
#include <string>
#include <vector>

#include "scene/formula/sdf.h"

namespace sundog {

struct LeafCode {
  std::string functions;  // <name>_distance, <name>_signed, <name>_sample; NAME stands for the name
  std::vector<double> parameters;
};

/// The functions take (p, active, q), q the first of `parameters`. Throws FormulaError.
LeafCode leaf_code(const FormulaField& field);

}  // namespace sundog
