// How much memory there is to take, and large pieces of it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace sundog {

/// Bytes that this process can still take: what the machine has available, or less where a cgroup (a
/// container, a batch job) or the limit of the address space leaves less. None where neither is known.
/// `root`: where proc and sys lie.
std::optional<std::uint64_t> available_memory(const std::filesystem::path& root = "/");

/// Asks for large pages where the system gives them to those who ask: memory that is about to be touched for
/// the first time then costs much less. Small pieces stay as they are.
void prefer_large_pages(void* at, std::size_t bytes);

/// For a program that makes frame after frame: keeps memory that is freed for what is allocated next, up to a
/// quarter of a GiB. Given back to the system, each 4 KiB of the next frame's films would cost a page fault.
/// Where the C library is not glibc it does nothing. To be called before there are threads.
void keep_freed_memory();

/// Makes an empty vector `size` zeros.
template <class T>
void fill_large(std::vector<T>& memory, std::size_t size) {
  memory.reserve(size);
  prefer_large_pages(memory.data(), size * sizeof(T));
  memory.resize(size);
}

}  // namespace sundog
