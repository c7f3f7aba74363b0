// Computes available memory as the minimum over /proc/meminfo, the limits of cgroups (versions 1 and 2), and
// the address space limit.
#include "base/memory.h"

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

namespace sundog {
namespace fs = std::filesystem;
namespace {

using MaybeBytes = std::optional<std::uint64_t>;

MaybeBytes less(const MaybeBytes& a, const MaybeBytes& b) { return a && b ? std::min(a, b) : a ? a : b; }

std::uint64_t rest(std::uint64_t limit, std::uint64_t used) { return limit > used ? limit - used : 0; }

/// Reads a file of one number; none for "max".
MaybeBytes number_in(const fs::path& file) {
  std::ifstream in(file);
  std::uint64_t value = 0;
  return in >> value ? MaybeBytes(value) : std::nullopt;
}

/// The number after `name` in a file of "name number" or "name: number" lines.
MaybeBytes number_of(const fs::path& file, std::string_view name) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string found;
    std::uint64_t value = 0;
    if (!(words >> found >> value)) continue;
    if (found.ends_with(':')) found.pop_back();
    if (found == name) return value;
  }
  return std::nullopt;
}

/// File names of a cgroup version.
struct Names {
  const char *limit, *used, *reclaimable;
};
constexpr Names version_1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr Names version_2{"memory.max", "memory.current", "inactive_file"};

MaybeBytes left_in(const fs::path& group, const Names& names) {
  const MaybeBytes limit = number_in(group / names.limit), used = number_in(group / names.used);
  if (!limit || !used) return std::nullopt;
  const std::uint64_t files = number_of(group / "memory.stat", names.reclaimable).value_or(0);
  return rest(*limit, rest(*used, files));
}

/// The minimum over a group and its ancestors, up to the mount point.
MaybeBytes left_up_from(const fs::path& mount, const std::string& group, const Names& names) {
  MaybeBytes least = left_in(mount, names);
  fs::path at = mount;
  for (const fs::path& part : fs::path(group).relative_path()) {
    at /= part;
    least = less(least, left_in(at, names));
  }
  return least;
}

/// The minimum over the process's cgroups. Lines: "0::/group" (version 2), "7:memory:/group" (version 1).
MaybeBytes left_in_groups(const fs::path& root) {
  std::ifstream in(root / "proc/self/cgroup");
  MaybeBytes least;
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    std::istringstream kinds(line.substr(first + 1, second - first - 1));
    const std::string group = line.substr(second + 1);
    if (second == first + 1) least = less(least, left_up_from(root / "sys/fs/cgroup", group, version_2));
    for (std::string kind; std::getline(kinds, kind, ',');)
      if (kind == "memory")
        least = less(least, left_up_from(root / "sys/fs/cgroup/memory", group, version_1));
  }
  return least;
}

MaybeBytes left_of_address_space(const fs::path& root) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  const MaybeBytes pages = number_in(root / "proc/self/statm");
  return rest(limit.rlim_cur, pages.value_or(0) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)));
}

}  // namespace

std::optional<std::uint64_t> available_memory(const fs::path& root) {
  MaybeBytes least = number_of(root / "proc/meminfo", "MemAvailable");
  if (least) *least *= 1024;
  return less(less(least, left_in_groups(root)), left_of_address_space(root));
}

void prefer_large_pages(void* at, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::size_t least = std::size_t{1} << 22;
  if (bytes < least) return;
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t skip = (page - reinterpret_cast<std::uintptr_t>(at) % page) % page;
  ::madvise(static_cast<char*>(at) + skip, (bytes - skip) / page * page, MADV_HUGEPAGE);
#else
  (void)at, (void)bytes;
#endif
}

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int largest_piece = 32 << 20, most = 256 << 20;  // larger blocks are unmapped when freed
  ::mallopt(M_MMAP_THRESHOLD, largest_piece);
  ::mallopt(M_TRIM_THRESHOLD, most);
  ::mallopt(M_MXFAST, 0);  // else each freed large block makes glibc merge the small blocks it keeps apart
#endif
}

}  // namespace sundog
