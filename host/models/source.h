// A model file's bytes, decompressed, and errors with a place in them.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace sundog::models {

inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // UTF-8's

struct Source {
  std::filesystem::path path;
  std::string bytes;           // after gunzip
  bool outside_files = false;  // may name files outside its folder
};

/// Reads the file. Unpacks it (zlib), within a bound, if its name ends in .gz, and removes a byte order mark,
/// except for STL and glTF. Throws SceneError.
Source read_source(const std::filesystem::path& path);

/// The extension in lower case, without a final .gz: ".obj" for "Box.OBJ.gz".
std::string model_extension(const std::filesystem::path& path);

[[noreturn]] void fail(const Source& source, const std::string& place, const std::string& what);
[[noreturn]] void fail_at_byte(const Source& source, std::size_t byte, const std::string& what);

}  // namespace sundog::models
