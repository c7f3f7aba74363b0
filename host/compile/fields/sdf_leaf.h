// Compiles one formula or hybrid to three functions: distance, two-sided distance, and sample (distance,
// gradient, orbit traps).
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "compile/fields/field_code.h"
#include "formula/sdf.h"

namespace sundog {

struct LeafCode {
  std::array<std::shared_ptr<const FieldCode>, 3> functions;  // distance, signed, sample
  std::vector<double> parameters;
};

/// The functions take (p, active, q), where q is the first of `parameters`. Throws FormulaError.
LeafCode leaf_code(const FormulaField& field);

}  // namespace sundog
