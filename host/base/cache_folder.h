// Checks and creates the cache folder, which must belong to the user, because sundog executes the kernels in
// it and trusts its tunings.
#pragma once
#include <filesystem>
#include <string>

namespace sundog {

/// Why `cache` (HostEnvironment::cache) is refused: it is not set, it or one of its folders belongs to
/// another user or is writable for others, or it cannot be inspected. Empty if it is usable.
std::string cache_refusal(const std::filesystem::path& cache);

/// The subfolder `name` of `cache`; empty if the cache is not set or refused.
std::filesystem::path cache_folder(const std::filesystem::path& cache, const std::string& name);

/// Creates a cache folder with its parents; sundog's own folders are private to the user (0700). Throws
/// IoError.
void make_cache_folder(const std::filesystem::path& folder);

}  // namespace sundog
