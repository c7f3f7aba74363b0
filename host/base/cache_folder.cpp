// Finds or creates the cache folder, and explains why a folder cannot be trusted.
#include "base/cache_folder.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"

namespace sundog {
namespace fs = std::filesystem;

namespace {

/// Why a folder cannot be trusted to be the user's own; empty if it can, or does not exist.
std::string refusal(const fs::path& folder) {
  struct stat found{};
  if (::stat(folder.c_str(), &found) != 0)
    return errno == EACCES ? fmt::format("{}: {}: name a folder of your own by XDG_CACHE_HOME",
                                         folder.string(), std::strerror(errno))
                           : "";
  if (!S_ISDIR(found.st_mode)) return fmt::format("{} is not a folder", folder.string());
  if (found.st_uid != ::geteuid())
    return fmt::format("{} belongs to another user: name a folder of your own by XDG_CACHE_HOME",
                       folder.string());
  if (found.st_mode & (S_IWGRP | S_IWOTH))
    return fmt::format("others may write to {}: remove it, and sundog makes a new one for you alone",
                       folder.string());
  return "";
}

}  // namespace

std::string cache_refusal(const fs::path& cache) {
  if (cache.empty()) return "the cache is not used: neither XDG_CACHE_HOME nor HOME names a folder";
  for (const fs::path& folder : {cache, cache / "kernels", cache / "tuning", cache / "pocl"})
    if (const std::string why = refusal(folder); !why.empty()) return "the cache is not used: " + why;
  return "";
}

fs::path cache_folder(const fs::path& cache, const std::string& name) {
  return cache.empty() || !cache_refusal(cache).empty() ? fs::path() : cache / name;
}

void make_cache_folder(const fs::path& folder) {
  const fs::path own = folder.parent_path();
  std::error_code failed;
  fs::create_directories(own.parent_path(), failed);
  for (const fs::path& made : {own, folder})
    if (!failed && ::mkdir(made.c_str(), 0700) != 0 && errno != EEXIST)
      failed = std::error_code(errno, std::generic_category());
  if (!failed && !fs::is_directory(folder, failed) && !failed)
    failed = std::make_error_code(std::errc::not_a_directory);
  if (failed) throw IoError(folder.string(), fmt::format("cannot be made: {}", failed.message()));
}

}  // namespace sundog
