// Files: whole reads, atomic writes, the cache folder.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace sundog {

/// The file's bytes. Throws IoError.
std::string read_file(const std::filesystem::path& path);

/// Writes a temporary beside `path` and renames it: the file appears whole or not at all. Throws IoError.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// $XDG_CACHE_HOME/sundog, else ~/.cache/sundog; empty when neither variable is set. Not created.
std::filesystem::path cache_directory();

}  // namespace sundog
