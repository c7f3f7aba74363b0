// Files that a model names, as far as its own folder has them.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/models/source.h"

namespace sundog::models {

/// The file that `model` means by `name`, from `folder` on: by the name as it stands, else with the slashes
/// of Windows turned, else by what stands after the last slash, because programs write down where the file
/// was on the machine of its author. Quotes around a name are no part of it, nor is a comment behind it,
/// where no file is called so. Leaves the model's folder only where that is allowed.
std::optional<std::filesystem::path> find_beside(const Source& model, const std::filesystem::path& folder,
                                                 std::string_view name);

/// Why there is no such file, for a warning.
std::string why_not_beside(const Source& model, const std::filesystem::path& folder, std::string_view name);

}  // namespace sundog::models
