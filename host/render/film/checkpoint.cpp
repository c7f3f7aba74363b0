// Checkpoints: the film of an interrupted frame. The file is a header, then the film's arrays, then a
// checksum, in the machine's own byte order (sundog runs on little-endian hosts).
#include <bit>
#include <cstring>
#include <fstream>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "base/limits.h"
#include "render/film/checkpoint_file.h"
#include "render/film/film.h"
#include "render/film/hash.h"

namespace sundog {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr char magic[8] = {'S', 'U', 'N', 'D', 'O', 'G', 'C', '1'};

struct Header {
  char magic[8];
  std::uint64_t key;
  std::int32_t width, height;
  std::uint64_t aovs;  // code() of their layout; 0: none
};

template <class T>
void append(std::string& out, const std::vector<T>& values) {
  out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <class T>
void take(const std::string& in, std::size_t& at, std::vector<T>& values) {
  const std::size_t size = values.size() * sizeof(T);
  if (size > 0) std::memcpy(values.data(), in.data() + at, size);
  at += size;
}

std::size_t bytes_of(const Film& film) {
  return film.sums.size() * sizeof(float4) + film.weights.size() * sizeof(float) +
         film.aovs.size() * sizeof(float4) + film.rays.size() * sizeof(u32) + film.done.size();
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Film& film, std::uint64_t key,
                      const std::shared_ptr<Faults>& faults) {
  Header header{};
  std::memcpy(header.magic, magic, sizeof magic);
  header.key = key;
  header.width = film.width;
  header.height = film.height;
  header.aovs = film.aovs.empty() ? 0 : film.layout.code();
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  bytes.reserve(sizeof header + bytes_of(film) + sizeof(std::uint64_t));
  append(bytes, film.sums);
  append(bytes, film.weights);
  append(bytes, film.aovs);
  append(bytes, film.rays);
  append(bytes, film.done);
  const std::uint64_t checksum = hash_bytes(bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  write_file(path, bytes, faults);
}

std::optional<std::uint64_t> checkpoint_key(const std::filesystem::path& path) {
  Header header{};
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header)) return std::nullopt;
  if (std::memcmp(header.magic, magic, sizeof magic) != 0) return std::nullopt;
  return header.key;
}

void read_checkpoint(const std::filesystem::path& path, Film& film, std::uint64_t key) {
  const std::size_t expected = sizeof(Header) + bytes_of(film);
  const std::string bytes = read_checkpoint_bytes(path, expected + sizeof(std::uint64_t));
  Header header{};
  std::uint64_t checksum = 0;
  const SceneError damaged = damaged_checkpoint(path);
  if (bytes.size() < sizeof header + sizeof checksum) throw damaged;
  std::memcpy(&header, bytes.data(), sizeof header);
  const std::size_t body = bytes.size() - sizeof checksum;
  std::memcpy(&checksum, bytes.data() + body, sizeof checksum);
  if (std::memcmp(header.magic, magic, sizeof magic) != 0 || checksum != hash_bytes(bytes.data(), body) ||
      !is_frame_size(header.width, header.height))
    throw damaged;
  if (header.key != key || header.width != film.width || header.height != film.height || body != expected ||
      header.aovs != (film.aovs.empty() ? 0 : film.layout.code()))
    throw other_checkpoint(path);
  std::size_t at = sizeof header;
  take(bytes, at, film.sums);
  take(bytes, at, film.weights);
  take(bytes, at, film.aovs);
  take(bytes, at, film.rays);
  take(bytes, at, film.done);
  if (!all_flags(film.done)) throw damaged;
}

}  // namespace sundog
