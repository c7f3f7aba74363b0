#include "base/file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "base/error.h"

namespace sundog {
namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::error_code status;
  if (fs::is_directory(path, status)) throw IoError(fmt::format("{}: is a directory", path.string()));
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write_file(const fs::path& path, std::string_view bytes) {
  static std::atomic<unsigned> serial{0};
  fs::path temporary = path;
  temporary += fmt::format(".{}.{}.tmp", ::getpid(), serial++);
  const auto fail = [&](int code) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw IoError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(code)));
  };
  errno = 0;
  std::ofstream out(temporary, std::ios::binary);
  if (!out) fail(errno);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) fail(errno ? errno : EIO);
  std::error_code renamed;
  fs::rename(temporary, path, renamed);
  if (renamed) fail(renamed.value());
}

fs::path cache_directory() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg) return fs::path(xdg) / "sundog";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "sundog";
  return {};
}

}  // namespace sundog
