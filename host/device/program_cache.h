// Compiled programs on disk, one file each under HostEnvironment::cache/kernels, so that a warm start
// compiles nothing.
#pragma once
#include <filesystem>
#include <optional>
#include <set>
#include <string>

namespace sundog {

struct HostEnvironment;

/// A file's contents. `variants` are the launches (kernel and local size) with machine code in the binary:
/// some drivers recompile a kernel for each local size, at its first launch.
struct CachedProgram {
  std::string binary;
  std::set<std::string> variants;
};

/// 128-bit FNV-1a as 32 hexadecimal digits.
std::string hash128(std::string_view bytes);

/// The file for the program of `key`; empty without a cache folder, or if kernels are not cached.
std::filesystem::path program_cache_file(const HostEnvironment& environment, const std::string& key);

/// Creates the folder of `file` if needed. Returns why nothing can be stored there; none if storing works.
std::optional<std::string> cannot_store(const std::filesystem::path& file);

/// The program stored for exactly this key; nothing if the file is missing, damaged, or has another format or
/// key.
std::optional<CachedProgram> load_program(const std::filesystem::path& file, const std::string& key);

/// Replaces the file atomically, and removes the least recently used files while the folder exceeds
/// `folder_bytes`. Throws IoError.
void store_program(const std::filesystem::path& file, const std::string& key, const CachedProgram& program,
                   std::uintmax_t folder_bytes = 256u << 20);

}  // namespace sundog
