// The cache folder: what lies in it is run (kernels) or believed (tuning), so it must be the user's own.
#pragma once
#include <filesystem>
#include <string>

namespace sundog {

/// Why `cache` (HostEnvironment::cache) is not used: another user owns it or one of its folders, others may
/// write there, or it cannot be looked into. Empty when it is used, or when there is none to use.
std::string cache_refusal(const std::filesystem::path& cache);

/// The folder of that name in `cache`; empty when there is no cache folder, or it is refused.
std::filesystem::path cache_folder(const std::filesystem::path& cache, const std::string& name);

/// Makes a folder of the cache with the folders above it; those of sundog's own are for the user alone
/// (0700). Throws IoError.
void make_cache_folder(const std::filesystem::path& folder);

}  // namespace sundog
