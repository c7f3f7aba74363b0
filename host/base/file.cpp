#include "base/file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <thread>

#include "base/error.h"
#include "base/faults.h"

namespace sundog {
namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::error_code status;
  if (fs::is_directory(path, status)) throw IoError(fmt::format("{}: is a directory", path.string()));
  const auto fail = [&] {
    throw IoError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) fail();
  std::string bytes;
  const std::uintmax_t expected = fs::file_size(path, status);  // unknown for a pipe: read until it ends
  std::size_t size = 0;
  do {
    bytes.resize(std::max<std::size_t>(size + (1 << 16), status ? 0 : expected + 1));
    size += std::fread(bytes.data() + size, 1, bytes.size() - size, file.get());
  } while (size == bytes.size());
  if (std::ferror(file.get())) fail();
  bytes.resize(size);
  return bytes;
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
  if (fault("write", path.filename().string())) fail(ENOSPC);
  while (fault("stall", path.filename().string())) std::this_thread::sleep_for(std::chrono::hours(1));
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

void check_writable(const fs::path& path) {
  std::error_code status;
  const auto fail = [&](std::string_view reason) {
    throw IoError(fmt::format("{}: cannot be written: {}", path.string(), reason));
  };
  if (fs::is_directory(path, status)) fail("it is a directory");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::exists(folder, status)) fail(fmt::format("there is no folder {}", folder.string()));
  if (!fs::is_directory(folder, status)) fail(fmt::format("{} is not a folder", folder.string()));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    fail(fmt::format("folder {}: {}", folder.string(), std::strerror(errno)));
}

fs::path cache_directory() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg) return fs::path(xdg) / "sundog";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "sundog";
  return {};
}

}  // namespace sundog
