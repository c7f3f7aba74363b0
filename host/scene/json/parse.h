// Text to JSON, strictly: comments are allowed; duplicate keys, overflowing numbers, NUL bytes, text that is
// not UTF-8 and absurd nesting are errors, each with its place.
#pragma once
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace sundog {

class Faults;

/// The deepest nesting of arrays and objects that a scene may have.
inline constexpr std::size_t max_json_depth = 100;

/// Throws SceneError{file, JSON pointer or "line L, column C", what}.
nlohmann::json parse_json(std::string_view text, const std::filesystem::path& file);

/// parse_json() of a whole file. Throws SceneError, also when the file is missing, a folder, unreadable or
/// empty.
nlohmann::json read_json_file(const std::filesystem::path& file,
                              const std::shared_ptr<Faults>& faults = nullptr);

/// Throws SceneError{named_in, place, what} unless `file` is there, is no folder and can be read.
void require_readable(const std::filesystem::path& file, const std::filesystem::path& named_in,
                      std::string_view place);

}  // namespace sundog
