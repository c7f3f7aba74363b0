// Lists the environment variables that drivers and sundog read, for reports.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace sundog {

/// The set variables that OpenCL's loader, drivers or sundog read, and the loader's list of drivers ("ICD
/// FILE" and the library that it names), sorted by name.
std::vector<std::pair<std::string, std::string>> driver_variables();

}  // namespace sundog
