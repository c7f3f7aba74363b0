// Files that the user names.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

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

/// A file by its place on a disk: the same under each of its names, be they links.
struct FileIdentity {
  std::uint64_t device = 0, inode = 0;
  friend bool operator==(const FileIdentity&, const FileIdentity&) = default;
};

struct ReadFile {
  std::filesystem::path path;  // as it was opened
  FileIdentity identity;
};

/// While it lives, each file that any thread reads by read_regular_file() or read_input() is noted in it, and
/// those that note_file() names.
class ReadLog {
 public:
  ReadLog();
  ~ReadLog();
  ReadLog(const ReadLog&) = delete;
  ReadLog& operator=(const ReadLog&) = delete;
  std::vector<ReadFile> files() const;

 private:
  friend struct ReadLogs;
  mutable std::mutex mutex_;
  std::vector<ReadFile> files_;
};

/// Notes a file that is named, and may not be read: nothing must take its place either.
void note_file(const std::filesystem::path& path);

}  // namespace sundog
