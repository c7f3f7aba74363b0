// Reads and writes cache files: magic and version, a checksum of the rest, three sizes, then key, variants
// and binary as one zlib stream. The key, which contains the kernel's source, is stored in full to detect
// hash collisions; compression reduces the file to a quarter.
#include "device/program_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <vector>

#include "base/cache_folder.h"
#include "base/deflate.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/file.h"
#include "base/input.h"

namespace sundog {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view magic = "sundog kernel 3\n";
constexpr std::uintmax_t most_bytes = std::uintmax_t{256} << 20;
constexpr std::size_t checksum_size = 32, size_size = 20;

std::string joined(const std::set<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::set<std::string> split(const std::string& text) {
  std::istringstream in(text);
  std::set<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.insert(line);
  return lines;
}

/// Reads fields from the front; `good` becomes false at a premature end.
struct Reader {
  std::string_view rest;
  bool good = true;

  std::string_view take(std::size_t count) {
    if (count > rest.size()) good = false;
    if (!good) return {};
    const std::string_view field = rest.substr(0, count);
    rest.remove_prefix(count);
    return field;
  }
  std::size_t take_size() {
    std::size_t size = 0;
    for (const char digit : take(size_size)) {
      if (digit < '0' || digit > '9' || size > (std::size_t{1} << 40)) good = false;
      size = size * 10 + static_cast<std::size_t>(digit - '0');
    }
    return size;
  }
};

/// Deletes the least recently used files until the folder is small enough. Races with other processes are
/// harmless.
void prune(const fs::path& folder, std::uintmax_t folder_bytes, const fs::path& keep) {
  struct Entry {
    fs::file_time_type used;
    std::uintmax_t bytes;
    fs::path path;
  };
  std::error_code ignored;
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  for (const auto& file : fs::directory_iterator(folder, ignored)) {
    std::error_code failed;
    const Entry entry{file.last_write_time(failed), file.file_size(failed), file.path()};
    if (failed) continue;
    entries.push_back(entry);
    total += entry.bytes;
  }
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& entry : entries) {
    if (total <= folder_bytes) return;
    if (entry.path == keep) continue;
    fs::remove(entry.path, ignored);
    total -= entry.bytes;
  }
}

}  // namespace

std::string hash128(std::string_view bytes) {
  __extension__ using u128 = unsigned __int128;
  constexpr u128 prime = (u128{1} << 88) + 0x13B;
  u128 hash = (u128{0x6C62272E07BB0142} << 64) + 0x62B821756295C58D;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * prime;
  return fmt::format("{:016x}{:016x}", static_cast<std::uint64_t>(hash >> 64),
                     static_cast<std::uint64_t>(hash));
}

fs::path program_cache_file(const HostEnvironment& environment, const std::string& key) {
  const fs::path folder = cache_folder(environment.cache, "kernels");
  if (folder.empty() || !environment.kernel_cache) return {};
  return folder / (hash128(key) + ".bin");
}

std::optional<CachedProgram> load_program(const fs::path& file, const std::string& key) {
  std::string bytes;
  try {
    bytes = read_regular_file(file, most_bytes);
  } catch (const IoError&) {
    return std::nullopt;
  }
  Reader reader{bytes};
  const bool known = reader.take(magic.size()) == magic;
  const std::string_view checksum = reader.take(checksum_size);
  if (!known || !reader.good || checksum != hash128(reader.rest)) return std::nullopt;
  const std::size_t key_size = reader.take_size(), variants_size = reader.take_size(),
                    binary_size = reader.take_size();
  constexpr std::size_t most_growth = 1100;  // zlib's maximum
  const std::size_t most_unpacked = std::min<std::size_t>(most_bytes, most_growth * reader.rest.size());
  if (!reader.good || key_size != key.size() || variants_size > most_unpacked || binary_size > most_unpacked)
    return std::nullopt;
  const std::optional<std::string> body = inflated(reader.rest, key_size + variants_size + binary_size);
  if (!body) return std::nullopt;
  Reader fields{*body};
  const std::string_view stored_key = fields.take(key_size);
  const std::string_view variants = fields.take(variants_size), binary = fields.take(binary_size);
  if (!fields.good || !fields.rest.empty() || stored_key != key || binary.empty()) return std::nullopt;
  std::error_code ignored;  // records the last use, for prune()
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  return CachedProgram{std::string(binary), split(std::string(variants))};
}

std::optional<std::string> cannot_store(const fs::path& file) {
  const fs::path folder = file.parent_path();
  try {
    make_cache_folder(folder);
  } catch (const IoError& error) {
    return error.what();
  }
  if (::access(folder.c_str(), W_OK) != 0)
    return fmt::format("{}: {}", folder.string(), std::strerror(errno));
  return std::nullopt;
}

void store_program(const fs::path& file, const std::string& key, const CachedProgram& program,
                   std::uintmax_t folder_bytes) {
  make_cache_folder(file.parent_path());
  const std::string variants = joined(program.variants);
  const std::string body = fmt::format("{:020}{:020}{:020}{}", key.size(), variants.size(),
                                       program.binary.size(), deflated(key + variants + program.binary));
  write_file(file, fmt::format("{}{}{}", magic, hash128(body), body));
  prune(file.parent_path(), folder_bytes, file);
}

}  // namespace sundog
