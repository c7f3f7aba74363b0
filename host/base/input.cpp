// Opens files without blocking, so that a pipe in place of a file is refused instead of waited for.
#include "base/input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "base/error.h"
#include "base/faults.h"

namespace sundog {

/// The live ReadLogs.
struct ReadLogs {
  std::mutex mutex;
  std::vector<ReadLog*> logs;

  static ReadLogs& all() {
    static ReadLogs logs;
    return logs;
  }
  void note(const ReadFile& file) {
    const std::lock_guard lock(mutex);
    for (ReadLog* log : logs) {
      const std::lock_guard its_lock(log->mutex_);
      log->files_.push_back(file);
    }
  }
};

namespace {

/// Closes the file on destruction.
struct File {
  int descriptor = -1;
  explicit File(const char* path) : descriptor(::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {}
  ~File() {
    if (descriptor >= 0) ::close(descriptor);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
};

bool is_own_stream(const std::string& path) {
  return path == "/dev/stdin" || path.starts_with("/dev/fd/") || path.starts_with("/proc/self/fd/");
}

std::string size_text(std::uintmax_t bytes) {
  return bytes % (1 << 20) == 0 ? fmt::format("{} MiB", bytes >> 20) : fmt::format("{} bytes", bytes);
}

/// Reads up to most + 1 bytes; returns false on a read error.
bool read_all(int descriptor, std::uintmax_t expected, std::uintmax_t most, std::string& bytes) {
  constexpr std::size_t step = 1 << 20;  // stays in the cache between its zeroing and its reading
  std::size_t size = 0;
  bytes.reserve(expected + 1);
  while (size <= most) {
    if (size == bytes.size())
      bytes.resize(size + (size < expected ? std::min(step, expected + 1 - size) : step));
    const ssize_t count = ::read(descriptor, bytes.data() + size, bytes.size() - size);
    if (count == 0) break;
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) size += static_cast<std::size_t>(count);
  }
  bytes.resize(size);
  return true;
}

}  // namespace

std::string read_regular_file(const std::filesystem::path& path, std::uintmax_t most,
                              const std::shared_ptr<Faults>& faults) {
  const auto fail = [&](const std::string& what) { throw IoError(path.string(), what); };
  const auto unreadable = [&] { fail(fmt::format("cannot be read: {}", std::strerror(errno))); };
  const File file(path.c_str());
  struct stat found{};
  if (file.descriptor < 0 || ::fstat(file.descriptor, &found) != 0) unreadable();
  if (S_ISDIR(found.st_mode)) fail("is a directory");
  const bool stream = S_ISFIFO(found.st_mode) && is_own_stream(path.string());
  if (!S_ISREG(found.st_mode) && !stream) fail("is no regular file, but a pipe or a device");
  ReadLogs::all().note({path, {found.st_dev, found.st_ino}});
  const auto size = S_ISREG(found.st_mode) ? static_cast<std::uintmax_t>(found.st_size) : 0;
  if (size > most) fail(fmt::format("is larger than {}", size_text(most)));
  ::fcntl(file.descriptor, F_SETFL, 0);  // block on streams
  while (fault(faults, "hold", path.filename().string())) std::this_thread::sleep_for(std::chrono::hours(1));
  std::string bytes;
  if (!read_all(file.descriptor, size, most, bytes)) unreadable();
  if (bytes.size() > most) fail(fmt::format("is larger than {}", size_text(most)));
  return bytes;
}

ReadLog::ReadLog() {
  ReadLogs& all = ReadLogs::all();
  const std::lock_guard lock(all.mutex);
  all.logs.push_back(this);
}

ReadLog::~ReadLog() {
  ReadLogs& all = ReadLogs::all();
  const std::lock_guard lock(all.mutex);
  std::erase(all.logs, this);
}

std::vector<ReadFile> ReadLog::files() const {
  const std::lock_guard lock(mutex_);
  return files_;
}

void note_file(const std::filesystem::path& path) {
  struct stat found{};
  if (::stat(path.c_str(), &found) == 0) ReadLogs::all().note({path, {found.st_dev, found.st_ino}});
}

std::string read_input(const std::filesystem::path& path, std::uintmax_t most,
                       const std::shared_ptr<Faults>& faults) {
  try {
    return read_regular_file(path, most, faults);
  } catch (const IoError& error) {
    throw SceneError(error.file, "", error.reason);
  }
}

bool leads_outside(const std::filesystem::path& file, const std::filesystem::path& named) {
  if (named.native().find('\0') != std::string::npos) return true;
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::canonical(
      file.has_parent_path() ? file.parent_path() : std::filesystem::path("."), failed);
  if (failed) return true;
  // weakly_canonical() does not make the relative path of a missing file absolute.
  const std::filesystem::path whole =
      std::filesystem::weakly_canonical(std::filesystem::absolute(named, failed), failed);
  if (failed) return true;
  return std::mismatch(folder.begin(), folder.end(), whole.begin(), whole.end()).first != folder.end();
}

}  // namespace sundog
