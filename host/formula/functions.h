// The functions of the formula language.
#pragma once
#include <string>
#include <vector>

#include "formula/value.h"

namespace sundog {

/// Applies the function `name`. Throws std::invalid_argument for an unknown name or unsuitable arguments.
Value call_function(Values& values, const std::string& name, const std::vector<Value>& arguments);

struct FunctionHelp {
  std::string call, meaning;
};
/// Every function and its arguments, for messages and the `formulas` command.
const std::vector<FunctionHelp>& function_help();

bool is_function(const std::string& name);

}  // namespace sundog
