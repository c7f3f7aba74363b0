// Reads files, and writes each to a locked temporary file beside it, which is then renamed. Writes directly
// to pipes and devices.
#include "base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/resource.h>
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
#include "base/names.h"

namespace sundog {
namespace fs = std::filesystem;

bool is_pipe_or_device(const fs::path& path) {
  const std::string name = path.string();
  for (const char* own : {"/dev/stdout", "/dev/stderr", "/dev/fd/", "/proc/self/fd/"})
    if (name.starts_with(own)) return true;
  struct stat found = {};
  return ::stat(path.c_str(), &found) == 0 && !S_ISREG(found.st_mode) && !S_ISDIR(found.st_mode);
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

std::string read_file(const fs::path& path) { return read_regular_file(path); }

namespace {

/// Shortens a name that would leave no room for a temporary file's suffix.
std::string shortened(std::string name) {
  constexpr std::size_t most = 200;  // file systems allow 255 bytes
  if (name.size() <= most) return name;
  std::size_t size = most;
  while (size > 0 && (static_cast<unsigned char>(name[size]) & 0xC0u) == 0x80u) --size;  // whole characters
  name.resize(size);
  return name;
}

/// Temporary files are named PATH.HOST.PID.N.tmp and locked while written; if one is unlocked, its writer has
/// died. The name contains the host, because locks may be invisible to other machines.
std::string temporary_prefix(const fs::path& path) {
  static const auto& host = *new const auto([] {
    char name[256] = {};
    ::gethostname(name, sizeof name - 1);
    return fmt::format("{:08x}", std::hash<std::string>()(name) & 0xFFFFFFFFu);
  }());
  return fmt::format("{}.{}.", shortened(path.filename().string()), host);
}

/// Resolves symbolic links, even dangling ones.
fs::path behind_links(fs::path path) {
  constexpr int most_links = 40;  // the kernel's limit
  std::error_code no_link;
  for (int i = 0; i < most_links; ++i) {
    const fs::path next = fs::read_symlink(path, no_link);
    if (no_link) break;
    path = path.parent_path() / next;
  }
  return path;
}

/// Writes all bytes to a pipe or device; waits for a pipe's reader.
bool write_into(const fs::path& path, std::string_view bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOCTTY);
  if (file < 0) return false;
  const bool written = write_all(file, bytes);
  const int code = errno;
  ::close(file);
  errno = code;
  return written;
}

/// An open, locked file beside its destination; deleted unless renamed to it.
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

  /// These return false and set errno on failure.
  bool is_open() const { return file_ >= 0; }
  bool write(std::string_view bytes) const {
    if (!write_all(file_, bytes)) return false;
    const int twin = ::dup(file_);  // closing it reports late write errors; the lock stays
    return twin < 0 || ::close(twin) == 0;
  }
  bool move_to(const fs::path& path) {
    if (::rename(path_.c_str(), path.c_str()) != 0) return false;
    path_.clear();
    return true;
  }

 private:
  /// Locks the file. Returns true if another process has locked it first, or removed it.
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
    throw IoError(path.string(), fmt::format("cannot be written: {}", write_error(code ? code : EIO)));
  };
  if (fault(faults, "write", path.filename().string())) fail(ENOSPC);
  if (is_pipe_or_device(path)) {
    if (!write_into(path, bytes)) fail(errno);
    return;
  }
  const fs::path place = behind_links(path);
  Temporary temporary(place);
  if (!temporary.is_open()) fail(errno);
  while (fault(faults, "stall", path.filename().string())) std::this_thread::sleep_for(std::chrono::hours(1));
  if (!temporary.write(bytes) || !temporary.move_to(place)) fail(errno);
}

void remove_left_over(const fs::path& named) {
  const fs::path path = behind_links(named);
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
    throw IoError(path.string(), fmt::format("cannot be written: {}", reason));
  };
  struct stat found = {};
  if (::stat(path.c_str(), &found) != 0 && (errno == ENAMETOOLONG || errno == ELOOP))
    fail(std::strerror(errno));
  if (fs::is_directory(path, status)) fail("it is a directory");
  if (is_pipe_or_device(path)) {
    if (::access(path.c_str(), W_OK) != 0) fail(std::strerror(errno));
    return;
  }
  const fs::path place = behind_links(path);
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  if (!fs::exists(folder, status)) fail(fmt::format("there is no folder {}", folder.string()));
  if (!fs::is_directory(folder, status)) fail(fmt::format("{} is not a folder", folder.string()));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    fail(fmt::format("folder {}: {}", folder.string(), std::strerror(errno)));
  if (::stat(folder.c_str(), &found) == 0 && found.st_nlink == 0)
    fail(fmt::format("the folder {} has been deleted: go to another", folder.string()));
}

bool is_there(const fs::path& path) {
  std::error_code failed;
  return fs::exists(path, failed);
}

std::string lower_extension(const fs::path& path) { return lower_case(path.extension().string()); }

fs::path working_folder() {
  std::error_code failed;
  fs::path folder = fs::current_path(failed);
  if (failed)
    throw IoError(fmt::format("the folder that sundog runs in: {}: go to another", failed.message()));
  return folder;
}

fs::path temporary_folder() {
  std::error_code failed;
  const fs::path folder = fs::temp_directory_path(failed);
  return failed ? fs::path("/tmp") : folder;
}

std::string write_error(int code) {
  rlimit limit = {};
  if (code != EFBIG || ::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::strerror(code);
  return fmt::format("{}: the limit on files (`ulimit -f`) is {} KiB: raise it", std::strerror(code),
                     limit.rlim_cur >> 10);
}

}  // namespace sundog
