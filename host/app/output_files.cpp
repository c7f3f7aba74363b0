// See output_files.h.
#include "app/output_files.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/error.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

/// Links followed as far as there are files.
fs::path place(const std::string& name) {
  std::error_code failed;
  const fs::path whole = fs::weakly_canonical(name, failed);
  return failed ? fs::path(name) : whole;
}

/// Devices and pipes: nothing in them is written over.
bool holds_nothing(const std::string& name) {
  std::error_code failed;
  return fs::exists(name, failed) && !fs::is_regular_file(name, failed);
}

}  // namespace

void check_output_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].empty() || holds_nothing(outputs[i])) continue;
    for (const std::string& input : inputs)
      if (place(outputs[i]) == place(input))
        throw UsageError(
            fmt::format("{}: is read, and would be written over: give the output another name", outputs[i]));
    for (std::size_t k = 0; k < i; ++k)
      if (!outputs[k].empty() && place(outputs[i]) == place(outputs[k]))
        throw UsageError(fmt::format("{}: is the name of two outputs: give each its own", outputs[i]));
  }
}

}  // namespace sundog
