// Creates, locks and removes PoCL's folder. A folder is in use while its file "lock" is locked; the kernel
// releases the lock when the process ends, however it ends.
#include "device/driver_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "base/cache_folder.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/faults.h"
#include "base/file.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

/// Locks the folder and returns a descriptor; negative, with the reason in errno, if another process holds
/// the lock (EWOULDBLOCK) or locks do not work.
int lock_folder(const fs::path& folder, int more_flags) {
  const int file = ::open((folder / "lock").c_str(), O_RDWR | O_CLOEXEC | more_flags, 0600);
  if (file < 0 || ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  const int reason = errno;
  ::close(file);
  errno = reason;
  return -1;
}

/// Whether the folder is so old that a living creator would have locked it.
bool is_old(const fs::path& folder) {
  std::error_code error;
  const auto written = fs::last_write_time(folder, error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(1);
}

constexpr std::string_view temporary_name = "sundog-pocl-";

/// Removes folders in `root` with this prefix that killed processes left.
void remove_left_over(const fs::path& root, std::string_view beginning) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root, error)) {
    if (!entry.path().filename().string().starts_with(beginning)) continue;
    const int lock = lock_folder(entry.path(), 0);
    if (lock < 0 && (fs::exists(entry.path() / "lock", error) || !is_old(entry.path()))) continue;
    fs::remove_all(entry.path(), error);
    if (lock >= 0) ::close(lock);
  }
}

// PoCL was seen to write 2 MiB for a scene's kernels. A folder with less free space than ample_room is used
// only if no other has more; a folder with less than least_room is useless.
constexpr std::uintmax_t ample_room = std::uintmax_t{32} << 20, least_room = std::uintmax_t{3} << 20;

/// Free bytes in a folder; none: unknown.
std::optional<std::uintmax_t> room_in(const fs::path& folder, const HostEnvironment& environment) {
  if (const auto kibibytes = fault(environment.faults, "room", "pocl"))
    return std::uintmax_t(*kibibytes) << 10;
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (error) return std::nullopt;
  return space.available;
}

/// PoCL loads compiled kernels as shared libraries.
bool forbids_execution(const fs::path& folder) {
  struct statvfs found = {};
  return ::statvfs(folder.c_str(), &found) == 0 && (found.f_flag & ST_NOEXEC) != 0;
}

/// The process's limit on file sizes in bytes; none: unlimited.
std::optional<std::uintmax_t> file_limit() {
  rlimit limit = {};
  if (::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

/// PoCL's compiler runs `ld`, and aborts the process without it.
bool finds_linker(const HostEnvironment& environment) {
  const std::string path = environment.driver("PATH");
  return path.empty() || has_program(path, "ld");
}

void try_to_make(const fs::path& folder) {
  try {
    make_cache_folder(folder);
  } catch (const IoError&) {  // use another folder
  }
}

/// Creates and locks a folder below `root`; empty on failure. Retries, because another process that removes
/// leftovers may lock the folder first. On a file system without locks, the folder is used unlocked.
std::string make_locked_below(const fs::path& root, std::string_view beginning) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    std::string folder = (root / beginning).string() + "XXXXXX";
    if (!::mkdtemp(folder.data())) break;
    std::error_code error;
    const int lock = lock_folder(folder, O_CREAT);
    const bool taken = lock < 0 && errno == EWOULDBLOCK;
    if (!taken && fs::exists(fs::path(folder) / "lock", error)) return folder;
    if (lock >= 0) ::close(lock);
    if (!taken) fs::remove_all(folder, error);
  }
  return "";
}

/// Creates a locked folder in the cache or, if that is not writable, full or mounted noexec, among the
/// temporary files; empty on failure.
std::string make_folder(const HostEnvironment& environment) {
  std::error_code error;
  const fs::path root = cache_folder(environment.cache, "pocl");
  if (!root.empty()) try_to_make(root);
  if (!root.empty() && fs::is_directory(root, error)) remove_left_over(root, "");
  if (!root.empty() && room_in(root, environment).value_or(0) >= ample_room && !forbids_execution(root)) {
    if (std::string folder = make_locked_below(root, ""); !folder.empty()) return folder;
  }
  const fs::path temporary = temporary_folder();
  remove_left_over(temporary, temporary_name);
  return make_locked_below(temporary, temporary_name);
}

}  // namespace

bool is_pocl(const DeviceInfo& device) { return device.platform_name == "Portable Computing Language"; }

DriverFolder::DriverFolder(const HostEnvironment& environment) noexcept : process_(::getpid()) {
  try {
    if (environment.driver("POCL_CACHE_DIR").empty()) {
      ::unsetenv("POCL_CACHE_DIR");  // PoCL aborts if it is empty
      own_ = make_folder(environment);
    }
    if (!own_.empty()) set_variable("POCL_CACHE_DIR", own_);
    const bool temporary = fs::path(own_).filename().string().starts_with(temporary_name);
    if (temporary) set_variable("MESA_SHADER_CACHE_DIR", own_);  // keep the user's
  } catch (const std::exception&) {
    // PoCL's own folder works too, while it is writable and undamaged.
  }
}

void DriverFolder::remove() const noexcept {
  std::error_code ignored;
  if (!own_.empty() && process_ == ::getpid()) fs::remove_all(own_, ignored);
}

std::string DriverFolder::problem(const HostEnvironment& environment) const {
  const std::string users = environment.driver("POCL_CACHE_DIR"), folder = users.empty() ? own_ : users;
  if (folder.empty())
    return "no folder can be made for what PoCL writes: name one that can be written by XDG_CACHE_HOME or "
           "TMPDIR";
  const std::string where = folder + ", where PoCL writes, ",
                    other = std::string("name another folder by ") +
                            (users.empty() ? "XDG_CACHE_HOME or TMPDIR" : "POCL_CACHE_DIR");
  if (forbids_execution(folder))
    return where + "is mounted noexec, and PoCL runs what it compiles from there: " + other;
  if (const auto room = room_in(folder, environment); room && *room < least_room)
    return where + fmt::format("has room for {} KiB, and {} are needed: make room, or {}", *room >> 10,
                               least_room >> 10, other);
  if (const auto most = file_limit(); most && *most < least_room)
    return fmt::format(
        "a file may have {} KiB (`ulimit -f`), and PoCL writes files of up to {}: raise the limit",
        *most >> 10, least_room >> 10);
  if (!finds_linker(environment))
    return "PoCL finds no linker `ld` in the folders of PATH: install it (Debian: binutils)";
  return "";
}

const DriverFolder& driver_folder(const HostEnvironment& environment) {
  static const DriverFolder folder(environment);
  return folder;
}

}  // namespace sundog
