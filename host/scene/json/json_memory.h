// What a JSON text takes as values, told from the text: a short one can take forty times its length.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace sundog {

/// How many of each a text has.
struct JsonCounts {
  std::uint64_t containers = 0;  // arrays and objects
  std::uint64_t keys = 0;
  std::uint64_t strings = 0;  // keys among them
  std::uint64_t values = 0;   // as many as there are at most
};
JsonCounts count_json(std::string_view text);

/// The bytes that these values take in memory, about.
std::uint64_t json_bytes(const JsonCounts& counts);

/// Throws SceneError, before anything is built, for a text whose values take more memory than any scene or
/// model of its length has use for, or than there is.
void check_json_memory(std::string_view text, const std::filesystem::path& file);

}  // namespace sundog
