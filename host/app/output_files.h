// What a command would write over by mistake.
#pragma once
#include <string>
#include <vector>

namespace sundog {

/// Throws UsageError where two of the outputs are one file, or an output is a file that is read. Empty names
/// are none.
void check_output_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

}  // namespace sundog
