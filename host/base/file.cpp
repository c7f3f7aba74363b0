#include "base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <thread>

#include "base/error.h"
#include "base/faults.h"
#include "base/input.h"

namespace sundog {
namespace fs = std::filesystem;

std::string read_file(const fs::path& path) { return read_regular_file(path); }

namespace {

/// Temporaries are PATH.HOST.PID.N.tmp and locked while they are written: one whose lock is free has lost its
/// writer. The host's name is in it because a lock may not be seen from another machine.
std::string temporary_prefix(const fs::path& path) {
  static const std::string host = [] {
    char name[256] = {};
    ::gethostname(name, sizeof name - 1);
    return fmt::format("{:08x}", std::hash<std::string>()(name) & 0xFFFFFFFFu);
  }();
  return fmt::format("{}.{}.", path.filename().string(), host);
}

/// An open, locked file beside its final place; removed at the end unless it was moved there.
class Temporary {
 public:
  explicit Temporary(const fs::path& path) {
    std::random_device random;
    do {
      close();
      path_ = path.parent_path() / fmt::format("{}{}.{}.tmp", temporary_prefix(path), ::getpid(), random());
      file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (file_ < 0 ? errno == EEXIST : taken_away());
  }
  ~Temporary() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove(path_, ignored);
    close();
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  /// These set errno where they fail.
  bool is_open() const { return file_ >= 0; }
  bool write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(file_, bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) return false;
      if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    const int twin = ::dup(file_);  // closing reports what the disk refuses late; the lock stays
    return twin < 0 || ::close(twin) == 0;
  }
  bool move_to(const fs::path& path) {
    if (::rename(path_.c_str(), path.c_str()) != 0) return false;
    path_.clear();
    return true;
  }

 private:
  /// Another process may have removed it before it was locked.
  bool taken_away() const {
    struct stat now = {};
    const bool locked = ::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    return !locked || (::fstat(file_, &now) == 0 && now.st_nlink == 0);
  }
  void close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }

  fs::path path_;
  int file_ = -1;
};

}  // namespace

void write_file(const fs::path& path, std::string_view bytes, const std::shared_ptr<Faults>& faults) {
  const auto fail = [&](int code) {
    throw IoError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(code ? code : EIO)));
  };
  if (fault(faults, "write", path.filename().string())) fail(ENOSPC);
  Temporary temporary(path);
  if (!temporary.is_open()) fail(errno);
  while (fault(faults, "stall", path.filename().string())) std::this_thread::sleep_for(std::chrono::hours(1));
  if (!temporary.write(bytes) || !temporary.move_to(path)) fail(errno);
}

void remove_left_over(const fs::path& path) {
  const std::string prefix = temporary_prefix(path);
  std::error_code failed;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (auto entry = fs::directory_iterator(folder, failed); !failed && entry != fs::directory_iterator();
       entry.increment(failed)) {
    const fs::path found = entry->path();
    const std::string name = found.filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(".tmp")) continue;
    const int file = ::open(found.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(found.c_str());
    ::close(file);
  }
}

void check_writable(const fs::path& path) {
  std::error_code status;
  const auto fail = [&](std::string_view reason) {
    throw IoError(fmt::format("{}: cannot be written: {}", path.string(), reason));
  };
  if (fs::is_directory(path, status)) fail("it is a directory");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::exists(folder, status)) fail(fmt::format("there is no folder {}", folder.string()));
  if (!fs::is_directory(folder, status)) fail(fmt::format("{} is not a folder", folder.string()));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    fail(fmt::format("folder {}: {}", folder.string(), std::strerror(errno)));
}

}  // namespace sundog
