// Reads files that the user names, and logs which files were read.
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

/// Reads a regular file of at most `most` bytes. Checks the type of the opened file, so that a pipe or device
/// cannot block. A pipe that the process has inherited may be named as /dev/stdin or /dev/fd/N. `faults` may
/// strike. Throws IoError "PATH: ...".
std::string read_regular_file(const std::filesystem::path& path, std::uintmax_t most = most_input_bytes,
                              const std::shared_ptr<Faults>& faults = nullptr);

/// read_regular_file(), but throws SceneError: an unreadable file is bad input.
std::string read_input(const std::filesystem::path& path, std::uintmax_t most = most_input_bytes,
                       const std::shared_ptr<Faults>& faults = nullptr);

/// Whether the path `named`, found in `file`, leads outside the folder of `file`, be it absolute, by "..", or
/// by a link. Opens nothing.
bool leads_outside(const std::filesystem::path& file, const std::filesystem::path& named);

/// The remedy, to end a message with.
inline constexpr const char* outside_hint = "allow outside files if it is to be read all the same";

/// Identifies a file on disk, whatever its name or links.
struct FileIdentity {
  std::uint64_t device = 0, inode = 0;
  friend bool operator==(const FileIdentity&, const FileIdentity&) = default;
};

struct ReadFile {
  std::filesystem::path path;  // as opened
  FileIdentity identity;
};

/// While it lives, records each file that any thread reads with read_regular_file() or read_input(), or
/// passes to note_file().
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

/// Records a file that need not be read but must not be overwritten.
void note_file(const std::filesystem::path& path);

}  // namespace sundog
