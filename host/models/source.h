// A model file's bytes, decompressed, and errors with a place in them.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace sundog::models {

inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // of UTF-8

struct Source {
  std::filesystem::path path;
  std::string bytes;           // after gunzip
  bool outside_files = false;  // may name files outside its folder
};

/// The file's bytes, of all but STL and glTF without a byte order mark; a name that ends in .gz is unpacked
/// (zlib), within a bound. Throws SceneError.
Source read_source(const std::filesystem::path& path);

/// The extension in lower case, without a final .gz: ".obj" for "Box.OBJ.gz".
std::string model_extension(const std::filesystem::path& path);

[[noreturn]] void fail(const Source& source, const std::string& place, const std::string& what);
[[noreturn]] void fail_at_byte(const Source& source, std::size_t byte, const std::string& what);

}  // namespace sundog::models
