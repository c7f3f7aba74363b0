// Compiled programs on disk: one file a program under HostEnvironment::cache/kernels, so that a warm start
// compiles nothing.
#pragma once
#include <filesystem>
#include <optional>
#include <set>
#include <string>

namespace sundog {

struct HostEnvironment;

/// A file's content. `variants` are the launches (kernel and local size) whose machine code the binary holds:
/// some drivers compile a kernel again for each local size, at its first launch.
struct CachedProgram {
  std::string binary;
  std::set<std::string> variants;
};

/// 128-bit FNV-1a as 32 hexadecimal digits.
std::string hash128(std::string_view bytes);

/// Where the program of `key` is kept; empty without a cache folder, or where kernels are not to be kept.
std::filesystem::path program_cache_file(const HostEnvironment& environment, const std::string& key);

/// Makes the folder of `file` if need be; why nothing can be stored there, or nothing.
std::optional<std::string> cannot_store(const std::filesystem::path& file);

/// The program stored for exactly this key; nothing when the file is missing, damaged, of another format or
/// of another key.
std::optional<CachedProgram> load_program(const std::filesystem::path& file, const std::string& key);

/// Replaces the file as a whole, and removes the files used longest ago while the folder holds more than
/// `folder_bytes`. Throws IoError.
void store_program(const std::filesystem::path& file, const std::string& key, const CachedProgram& program,
                   std::uintmax_t folder_bytes = 256u << 20);

}  // namespace sundog
