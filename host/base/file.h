// Files: whole reads, atomic writes.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace sundog {

class Faults;

/// The file's bytes. Throws IoError "PATH: cannot be read: ...".
std::string read_file(const std::filesystem::path& path);

/// Writes a temporary beside `path` and renames it: the file appears whole or not at all. `faults` may
/// strike. Throws IoError.
void write_file(const std::filesystem::path& path, std::string_view bytes,
                const std::shared_ptr<Faults>& faults = nullptr);

/// Removes what write_file() calls for `path` have left that were killed on this machine; never what another
/// process is writing.
void remove_left_over(const std::filesystem::path& path);

/// Throws IoError when `write_file` would fail for want of a folder or a permission: call it before long
/// work.
void check_writable(const std::filesystem::path& path);

}  // namespace sundog
