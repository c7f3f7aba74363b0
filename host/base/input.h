// Files that the user names.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace sundog {

class Faults;

constexpr std::uintmax_t most_input_bytes = std::uintmax_t{2} << 30;

/// The bytes of a regular file of at most `most` bytes; whether it is one is asked of the opened file, and a
/// pipe or a device is not waited for. A pipe that the caller has opened itself may be named: /dev/stdin,
/// /dev/fd/N. `faults` may strike. Throws IoError "PATH: ...".
std::string read_regular_file(const std::filesystem::path& path, std::uintmax_t most = most_input_bytes,
                              const std::shared_ptr<Faults>& faults = nullptr);

/// The same. Throws SceneError: a file that cannot be read is a bad input.
std::string read_input(const std::filesystem::path& path, std::uintmax_t most = most_input_bytes,
                       const std::shared_ptr<Faults>& faults = nullptr);

}  // namespace sundog
