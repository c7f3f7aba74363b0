// Parses JSON strictly. Comments are allowed; duplicate keys, overflowing numbers, NUL bytes, invalid UTF-8
// and excessive nesting are errors with their place.
#pragma once
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace sundog {

class Faults;

/// Maximum nesting of arrays and objects in a scene.
inline constexpr std::size_t max_json_depth = 100;

/// Parses a document. Throws SceneError{file, JSON pointer or "line L, column C", what}.
nlohmann::json parse_json(std::string_view text, const std::filesystem::path& file);

/// Parses a whole file. Throws SceneError, also if the file is missing, a folder, unreadable or empty.
nlohmann::json read_json_file(const std::filesystem::path& file,
                              const std::shared_ptr<Faults>& faults = nullptr);

/// Throws SceneError{named_in, place, what} unless `file` exists, is not a folder and is readable.
void require_readable(const std::filesystem::path& file, const std::filesystem::path& named_in,
                      std::string_view place);

}  // namespace sundog
