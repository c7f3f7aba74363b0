// Command-line overrides: "/camera/fov=30" changes one value of a JSON document.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace sundog {

/// Sets the value at a JSON pointer, in which an item of an array may also be called by its "name" where no
/// other item has that. A missing last key is added, and so are the objects around it, but for named things
/// (there is no material "galss" to change); "-" appends to an array. Throws SceneError{file, pointer, what}
/// for a pointer that leads nowhere: "`subject` leads nowhere: ...".
void set_value(nlohmann::json& document, std::string_view pointer, nlohmann::json value,
               const std::filesystem::path& file, std::string_view subject);

/// set_value() by an override "JSON_POINTER=VALUE". VALUE is JSON, else a string. Throws UsageError for text
/// of another form.
void apply_override(nlohmann::json& document, std::string_view setting, const std::filesystem::path& file);

/// The pointer with indices in place of items' names, and that of the last item in place of "-".
std::string resolve_names(const nlohmann::json& document, std::string_view pointer);

/// resolve_names() of an override's pointer.
std::string pointer_of(const nlohmann::json& document, std::string_view setting);

/// Whether the value at `longer` is that at `shorter` or a part of it.
bool leads_through(std::string_view longer, std::string_view shorter);

/// Whether one of two pointers leads through the other.
bool overlap(std::string_view a, std::string_view b);

/// True when an error at `place` may come of the override, whose pointer has no names.
bool concerns(std::string_view setting, std::string_view place);

}  // namespace sundog
