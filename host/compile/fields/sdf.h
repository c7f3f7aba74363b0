// From descriptions of signed distance fields to the OpenCL C that computes them ("generated/sdf.cl") and its
// tables.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "scene/formula/sdf.h"
#include "shared/sdf.h"

namespace sundog {

/// `source` depends on the formulas, their whole exponents and how the fields are put together; every other
/// number is in `parameters`, so that changing it builds no kernel anew. Behind the numbers stand the same
/// fields as programs.
struct CompiledFields {
  std::string source;  // text of generated/sdf.cl; empty when there are no fields
  std::vector<float> parameters;
  std::vector<SdfField> fields;  // as many as there were descriptions
};

/// What stands for a scene's own `source` where kernels run the fields' programs, whatever the fields.
inline constexpr const char* interpreting_source = "#include \"lib/sdf/interpret.cl\"\n";

/// Whether the parameters hold the fields as programs too, which kernels/lib/sdf/interpret.cl runs.
bool have_programs(std::span<const float> parameters);

/// Pure. Throws FormulaError.
CompiledFields compile_fields(std::span<const SdfDescription> fields);

}  // namespace sundog
