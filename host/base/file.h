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

/// Writes a temporary beside `path` and renames it: the file appears whole or not at all. A symbolic link
/// stays, and what it names is written; into a pipe or a device the bytes are written as they are. `faults`
/// may strike. Throws IoError.
void write_file(const std::filesystem::path& path, std::string_view bytes,
                const std::shared_ptr<Faults>& faults = nullptr);

/// Removes what write_file() calls for `named` have left that were killed on this machine; never what another
/// process is writing.
void remove_left_over(const std::filesystem::path& named);

/// Throws IoError when `write_file` would fail for want of a folder or a permission, or by its name: call it
/// before long work.
void check_writable(const std::filesystem::path& path);

/// Whether that is a pipe, a device or a stream of this process: what is written there is not kept under the
/// name.
bool is_pipe_or_device(const std::filesystem::path& path);

/// Whether something is there. Where that cannot be found out, as in a folder that may not be entered, there
/// is nothing that could be used.
bool is_there(const std::filesystem::path& path);

/// The folder that the process is in. Throws IoError where it has been deleted.
std::filesystem::path working_folder();

/// The folder for temporary files: TMPDIR's where that is one.
std::filesystem::path temporary_folder();

/// strerror(), with the limit by which the system refuses to let a file grow.
std::string write_error(int code);

}  // namespace sundog
