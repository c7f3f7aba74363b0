// Measures available memory, and speeds up the allocation of large blocks.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace sundog {

/// Bytes that this process can still allocate: the machine's available memory, or less if a cgroup (a
/// container, a batch job) or the address space limit allows less. None if unknown. `root` contains proc and
/// sys.
std::optional<std::uint64_t> available_memory(const std::filesystem::path& root = "/");

/// Requests huge pages for untouched memory, so that first touches cost much less. Ignores small blocks.
void prefer_large_pages(void* at, std::size_t bytes);

/// For programs that render many frames: keeps up to 256 MiB of freed memory for later allocations; otherwise
/// every 4 KiB of the next frame's films cost a page fault. Needs glibc. Call before starting threads.
void keep_freed_memory();

/// Grows an empty vector to `size` zeros.
template <class T>
void fill_large(std::vector<T>& memory, std::size_t size) {
  memory.reserve(size);
  prefer_large_pages(memory.data(), size * sizeof(T));
  memory.resize(size);
}

}  // namespace sundog
