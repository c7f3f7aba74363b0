// A folder is in use while its file "lock" is locked: the kernel lets go of the lock when a process ends,
// however it ends.
#include "device/driver_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

#include "base/cache_folder.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/faults.h"
#include "base/file.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

/// A descriptor that holds the folder's lock; negative when another has it, or there is none to hold.
int lock_folder(const fs::path& folder, int more_flags) {
  const int file = ::open((folder / "lock").c_str(), O_RDWR | O_CLOEXEC | more_flags, 0600);
  if (file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  if (file >= 0) ::close(file);
  return -1;
}

/// Old enough that its maker would have locked it by now.
bool is_old(const fs::path& folder) {
  std::error_code error;
  const auto written = fs::last_write_time(folder, error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(1);
}

constexpr std::string_view temporary_name = "sundog-pocl-";

/// Folders in `root` whose names begin so, of processes that were killed.
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

// PoCL was seen to write 2 MiB for a scene's kernels; a folder with less room than the first is not chosen
// where there is another, and one with less than the second is of no use.
constexpr std::uintmax_t ample_room = std::uintmax_t{32} << 20, least_room = std::uintmax_t{3} << 20;

/// Bytes that can be written there; none: nobody knows.
std::optional<std::uintmax_t> room_in(const fs::path& folder, const HostEnvironment& environment) {
  if (const auto kibibytes = fault(environment.faults, "room", "pocl"))
    return std::uintmax_t(*kibibytes) << 10;
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (error) return std::nullopt;
  return space.available;
}

void try_to_make(const fs::path& folder) {
  try {
    make_cache_folder(folder);
  } catch (const IoError&) {  // then another folder is used
  }
}

/// A new folder below `root`, locked; empty: none can be made. Another process that removes folders left over
/// may take one before it is locked: then another is made.
std::string make_locked_below(const fs::path& root, std::string_view beginning) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    std::string folder = (root / beginning).string() + "XXXXXX";
    if (!::mkdtemp(folder.data())) break;
    std::error_code error;
    const int lock = lock_folder(folder, O_CREAT);
    if (lock >= 0 && fs::exists(fs::path(folder) / "lock", error)) return folder;
    if (lock >= 0) ::close(lock);
  }
  return "";
}

/// A new locked folder in the cache, or where that cannot be written or is full, among the temporary files;
/// empty: neither can.
std::string make_folder(const HostEnvironment& environment) {
  std::error_code error;
  const fs::path root = cache_folder(environment.cache, "pocl");
  if (!root.empty()) try_to_make(root);
  if (!root.empty() && fs::is_directory(root, error)) remove_left_over(root, "");
  if (!root.empty() && room_in(root, environment).value_or(0) >= ample_room) {
    if (std::string folder = make_locked_below(root, ""); !folder.empty()) return folder;
  }
  const fs::path temporary = fs::temp_directory_path(error);
  remove_left_over(temporary, temporary_name);
  return make_locked_below(temporary, temporary_name);
}

}  // namespace

bool is_pocl(const DeviceInfo& device) { return device.platform_name == "Portable Computing Language"; }

DriverFolder::DriverFolder(const HostEnvironment& environment) noexcept {
  try {
    if (!environment.driver("POCL_CACHE_DIR").empty()) return;
    ::unsetenv("POCL_CACHE_DIR");  // an empty one ends PoCL's process
    const std::string folder = make_folder(environment);
    if (folder.empty()) return;
    own_ = folder;
    ::setenv("POCL_CACHE_DIR", folder.c_str(), 1);
    const bool temporary = fs::path(folder).filename().string().starts_with(temporary_name);
    if (temporary) ::setenv("MESA_SHADER_CACHE_DIR", folder.c_str(), 0);  // the user's stays
  } catch (const std::exception&) {
    // PoCL's own folder does as well, as long as it can be written and nothing damages it.
  }
}

void DriverFolder::remove() const noexcept {
  std::error_code ignored;
  if (!own_.empty()) fs::remove_all(own_, ignored);
}

std::string DriverFolder::problem(const HostEnvironment& environment) const {
  const std::string users = environment.driver("POCL_CACHE_DIR"), folder = users.empty() ? own_ : users;
  if (folder.empty())
    return "no folder can be made for what PoCL writes: name one that can be written by XDG_CACHE_HOME or "
           "TMPDIR";
  const auto room = room_in(folder, environment);
  if (!room || *room >= least_room) return "";
  return fmt::format(
      "{}, where PoCL writes, has room for {} KiB, and {} are needed: make room, or name another "
      "folder by {}",
      folder, *room >> 10, least_room >> 10, users.empty() ? "XDG_CACHE_HOME or TMPDIR" : "POCL_CACHE_DIR");
}

const DriverFolder& driver_folder(const HostEnvironment& environment) {
  static const DriverFolder folder(environment);
  return folder;
}

}  // namespace sundog
