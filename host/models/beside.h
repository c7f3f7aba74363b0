// Finds files that a model names, usually inside its own folder.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/source.h"

namespace sundog::models {

/// Finds the file that `model` names, relative to `folder`: by the name as written, else with backslashes as
/// slashes, else by its last component, because programs write paths from their author's machine, and each
/// in another case of letters, which adds to `warnings`. Strips quotes, and a trailing comment if no such
/// file exists. Leaves the model's folder only if allowed.
std::optional<std::filesystem::path> find_beside(const Source& model, const std::filesystem::path& folder,
                                                 std::string_view name, std::vector<std::string>& warnings);

/// The reason why the file was not found, for a warning.
std::string why_not_beside(const Source& model, const std::filesystem::path& folder, std::string_view name);

}  // namespace sundog::models
