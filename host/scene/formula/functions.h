// The functions of the formula language.
#pragma once
#include <string>
#include <vector>

#include "scene/formula/value.h"

namespace sundog {

/// Applies the function `name`. Throws std::invalid_argument when there is none or the arguments do not fit
/// it.
Value call_function(Values& values, const std::string& name, const std::vector<Value>& arguments);

struct FunctionHelp {
  std::string call, meaning;
};
/// Every function with its arguments, for messages and for the `formulas` command.
const std::vector<FunctionHelp>& function_help();

bool is_function(const std::string& name);

}  // namespace sundog
