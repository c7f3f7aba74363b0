// Environment variables that drivers and sundog read, for reports.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace sundog {

/// The variables that OpenCL's loader, drivers or sundog read, as they are set now, and the loader's list of
/// drivers ("ICD FILE": the library that it names). In order.
std::vector<std::pair<std::string, std::string>> driver_variables();

}  // namespace sundog
