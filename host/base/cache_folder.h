// The cache folder. Kernels in it are executed and tunings are trusted, so it must belong to the user.
#pragma once
#include <filesystem>
#include <string>

namespace sundog {

/// Why `cache` (HostEnvironment::cache) is refused: it is not set, another user owns it or a folder in it,
/// others may write there, or it cannot be inspected. Empty if it is usable.
std::string cache_refusal(const std::filesystem::path& cache);

/// The subfolder `name` of `cache`; empty if the cache is not set or refused.
std::filesystem::path cache_folder(const std::filesystem::path& cache, const std::string& name);

/// Creates a cache folder with its parents; sundog's own folders are private to the user (0700). Throws
/// IoError.
void make_cache_folder(const std::filesystem::path& folder);

}  // namespace sundog
