// The code of fields as programs for the kernels' interpreter (kernels/lib/sdf/interpret.cl).
#pragma once
#include <span>
#include <vector>

#include "compile/fields/field_code.h"

namespace sundog {

/// Instructions that the functions of all fields may have together.
inline constexpr std::size_t max_program = 16384;

/// `functions`: each field's distance, signed, sample and, of uneven fields, near. Returns four words a
/// field, where they begin, counted from the first word, and then the instructions. Empty where a program
/// cannot do what they do (native code), or takes more registers or instructions than there are.
std::vector<u32> field_programs(std::span<const std::vector<FieldCode>> functions);

/// The instructions of one function; empty where there can be none. Pure.
std::vector<u32> field_program(const FieldCode& code);

}  // namespace sundog
