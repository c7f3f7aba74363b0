// Command-line overrides: "/camera/fov=30" changes one value of a JSON document.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace sundog {

/// Sets the value that an override "JSON_POINTER=VALUE" names. VALUE is JSON, or else taken as a string. A
/// missing last key is added, and so are the objects around it, but for named things (there is no material
/// "galss" to change); "-" appends to an array. Throws UsageError for text of another form, SceneError{file,
/// pointer, what} for a pointer that leads nowhere.
void apply_override(nlohmann::json& document, std::string_view setting, const std::filesystem::path& file);

/// True when an error at `place` may come of the override: one of the two pointers leads through the other.
bool concerns(std::string_view setting, std::string_view place);

}  // namespace sundog
