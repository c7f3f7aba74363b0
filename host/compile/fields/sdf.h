// Compiles signed distance fields to OpenCL C ("generated/sdf.cl") and tables.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "formula/sdf.h"
#include "shared/sdf.h"

namespace sundog {

/// `source` depends only on the formulas, their integer exponents and the structure of the fields; all other
/// numbers are in `parameters`, so changing them rebuilds no kernel. The fields' programs follow the numbers.
struct CompiledFields {
  std::string source;  // generated/sdf.cl; empty without fields
  std::vector<float> parameters;
  std::vector<SdfField> fields;  // one per description
};

/// Replaces `source` in kernels that interpret the fields' programs; the same text for all fields.
inline constexpr const char* interpreting_source = "#include \"lib/sdf/interpret.cl\"\n";

/// Whether the parameters include programs, which kernels/lib/sdf/interpret.cl runs.
bool have_programs(std::span<const float> parameters);

/// Pure. Throws FormulaError.
CompiledFields compile_fields(std::span<const SdfDescription> fields);

}  // namespace sundog
