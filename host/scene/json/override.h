// Command-line overrides: "/camera/fov=30" changes one value of a JSON document.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace sundog {

/// Applies an override "JSON_POINTER=VALUE". VALUE is JSON, or else a string. Creates a missing last key and
/// its parent objects, except named things (a misspelt material "galss" is an error); "-" appends to an
/// array. Throws UsageError for malformed text, SceneError{file, pointer, what} for a pointer that leads
/// nowhere.
void apply_override(nlohmann::json& document, std::string_view setting, const std::filesystem::path& file);

/// Whether an error at `place` may come from the override: one pointer is a prefix of the other.
bool concerns(std::string_view setting, std::string_view place);

}  // namespace sundog
