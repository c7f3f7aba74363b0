// How much memory there is to take.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>

namespace sundog {

/// Bytes that this process can still take: what the machine has available, or less where a cgroup (a
/// container, a batch job) or the limit of the address space leaves less. None where nobody says. `root`:
/// where proc and sys lie.
std::optional<std::uint64_t> available_memory(const std::filesystem::path& root = "/");

}  // namespace sundog
