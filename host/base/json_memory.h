// Estimates the memory that a JSON text needs when parsed: up to forty times its length.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace sundog {

/// Number of values in a text, by type.
struct JsonCounts {
  std::uint64_t containers = 0;  // arrays and objects
  std::uint64_t keys = 0;
  std::uint64_t strings = 0;  // including keys
  std::uint64_t values = 0;   // upper bound
};
JsonCounts count_json(std::string_view text);

/// Approximate memory of these values in bytes.
std::uint64_t json_bytes(const JsonCounts& counts);

/// Throws SceneError for a text whose values need more memory than is plausible for its length or than is
/// available. Call before parsing.
void check_json_memory(std::string_view text, const std::filesystem::path& file);

}  // namespace sundog
