// Compiles fields' code to programs for the kernels' interpreter (kernels/lib/sdf/interpret.cl).
#pragma once
#include <span>
#include <vector>

#include "compile/fields/field_code.h"

namespace sundog {

/// Limit of instructions for all fields together.
inline constexpr std::size_t max_program = 16384;

/// `functions`: each field's distance, signed, sample and, for uneven fields, near. Returns four start
/// offsets per field, in words from the beginning, then the instructions. Empty if programs cannot express
/// the fields (native code), or exceed the registers or instructions.
std::vector<u32> field_programs(std::span<const std::vector<FieldCode>> functions);

/// The instructions of one function; empty if a program cannot express it. Pure.
std::vector<u32> field_program(const FieldCode& code);

}  // namespace sundog
