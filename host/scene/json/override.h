// Sets single values of a JSON document by pointer, as in the command line's "/camera/fov=30".
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace sundog {

/// Sets the value at a JSON pointer, in which an array item may also be given by its "name" if no other item
/// has that name; "/objects/NAME" may be in a group. Adds a missing last key and what is missing before it,
/// arrays as the schema's defaults, except named things (there is no material "galss" to change); "-" appends
/// to an array. Throws SceneError{file, pointer, what} for a pointer that leads nowhere: "`subject` leads
/// nowhere: ...".
void set_value(nlohmann::json& document, std::string_view pointer, nlohmann::json value,
               const std::filesystem::path& file, std::string_view subject);

/// Calls set_value() for an override "JSON_POINTER=VALUE". VALUE is JSON or, failing that, a string. Throws
/// UsageError for a malformed override.
void apply_override(nlohmann::json& document, std::string_view setting, const std::filesystem::path& file);

/// The value at a pointer as of set_value(), or the schema's default for it; null: none.
nlohmann::json value_or_default(const nlohmann::json& document, std::string_view pointer);

/// The pointer with indices in place of items' names.
std::string resolve_names(const nlohmann::json& document, std::string_view pointer);

/// resolve_names() of the pointer of an override that was applied: "-" is the last item, but for `later` ones
/// that further overrides have appended.
std::string pointer_of(const nlohmann::json& document, std::string_view setting, std::size_t later = 0);

/// Whether the value at `longer` is the value at `shorter` or a part of it.
bool leads_through(std::string_view longer, std::string_view shorter);

/// Whether one of two pointers leads through the other.
bool overlap(std::string_view a, std::string_view b);

/// Whether an error at `place` may be caused by the override, whose pointer contains no names.
bool concerns(std::string_view setting, std::string_view place);

}  // namespace sundog
