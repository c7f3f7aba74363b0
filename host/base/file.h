// Reads whole files and writes files atomically.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace sundog {

class Faults;

/// The file's bytes. Throws IoError "PATH: cannot be read: ...".
std::string read_file(const std::filesystem::path& path);

/// Writes a temporary file beside `path` and renames it, so that the file appears whole or not at all.
/// Follows symbolic links; writes directly into a pipe or device. `faults` may strike. Throws IoError.
void write_file(const std::filesystem::path& path, std::string_view bytes,
                const std::shared_ptr<Faults>& faults = nullptr);

/// Writes all bytes at an open file's current position. Returns false and sets errno on failure.
bool write_all(int file, std::string_view bytes);

/// Removes temporary files for `named` that killed processes of this machine left; never those in use.
void remove_left_over(const std::filesystem::path& named);

/// Throws IoError if write_file() would fail because of the name, the folder or permissions. Call it before
/// long work.
void check_writable(const std::filesystem::path& path);

/// Whether `path` is a pipe, a device, or a stream of this process, which does not store what is written.
bool is_pipe_or_device(const std::filesystem::path& path);

/// Whether `path` exists. False if that cannot be determined, as in a folder that may not be entered.
bool is_there(const std::filesystem::path& path);

/// The extension in lower case, with its dot.
std::string lower_extension(const std::filesystem::path& path);

/// The current folder. Throws IoError if it has been deleted.
std::filesystem::path working_folder();

/// The folder for temporary files: $TMPDIR if valid.
std::filesystem::path temporary_folder();

/// strerror(), and for EFBIG the file size limit.
std::string write_error(int code);

}  // namespace sundog
