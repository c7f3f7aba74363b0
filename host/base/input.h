// Files that the user names.
#pragma once
#include <filesystem>
#include <string>

namespace sundog {

/// The file's bytes. Throws SceneError: one that cannot be read is a bad input.
std::string read_input(const std::filesystem::path& path);

}  // namespace sundog
