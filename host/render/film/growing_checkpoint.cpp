// Checkpoints of frames made in passes: a header, then arrays, each behind its length, then a checksum.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "base/limits.h"
#include "render/film/checkpoint_file.h"
#include "render/film/growing_film.h"
#include "render/film/hash.h"

namespace sundog {
namespace {

constexpr char growing_magic[8] = {'S', 'U', 'N', 'D', 'O', 'G', 'P', '3'};

struct GrowingHeader {
  char magic[8];
  std::uint64_t key;
  std::int32_t width, height, pass_width, pass_height;
  std::uint32_t first_sample, sample_count, surfaces, costs, aovs, has_block_rays;
  std::uint32_t stage, step;
  std::uint64_t surfaces_seen;
};

/// Calls visit(array) for each array of the file, in its order.
template <class Growing, class Pixels, class Made, class Visit>
void for_each_array(Growing& film, Pixels& pixels, Made& made, const Visit& visit) {
  visit(film.film.sums), visit(film.film.weights), visit(film.film.aovs), visit(film.film.rays),
      visit(film.film.done);
  visit(film.taken), visit(film.states), visit(film.earlier), visit(film.moved), visit(film.block_rays);
  visit(pixels);
  visit(made.sums), visit(made.weights), visit(made.aovs), visit(made.rays), visit(made.done);
}

constexpr std::size_t sample_bytes = sizeof(float4) + sizeof(float) + 1;  // sums, weight, whether it is done

/// Throws SceneError where the file is too short for the pixels of its pass: no memory is taken for them.
void check_memory(const std::filesystem::path& path, const GrowingFilm& film, const Pass& pass,
                  std::size_t file_bytes) {
  const auto pixels = static_cast<std::uintmax_t>(pass.width) * static_cast<std::uintmax_t>(pass.height);
  const std::size_t a_pixel =
      sample_bytes + (pass.surfaces ? sizeof(float4) * film.film.layout.vectors() : 0);
  if (pixels * a_pixel > file_bytes)
    throw SceneError(path.string(), "",
                     fmt::format("is a damaged checkpoint: it says {}x{} pixels in {} bytes; remove it to "
                                 "start anew",
                                 pass.width, pass.height, file_bytes));
}

/// More than a checkpoint of that frame has: a list of pixels is padded to rows of whole blocks.
std::uintmax_t most_bytes(const GrowingFilm& film) {
  constexpr std::uintmax_t of_film = sample_bytes + sizeof(float4) * most_aov_vectors + sizeof(u32),
                           of_growth = 4 * sizeof(u32) + sizeof(PixelState) + sizeof(float4);
  constexpr std::uintmax_t more = std::uintmax_t{1} << 16;
  return (2 * of_film + of_growth) * (film.taken.size() + more);
}

/// Whether the pixels are the image's own, or a list as list_pass() makes it: each pixel once.
bool are_pixels_of(const GrowingFilm& film, const Pass& pass) {
  if (pass.pixels.empty()) return pass.width == film.film.width && pass.height == film.film.height;
  if (!is_list_size(pass.width, pass.height)) return false;
  std::vector<bool> listed(film.taken.size());
  for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
    const u32 pixel = pass.pixels[i];
    if (pixel == NO_PIXEL) continue;
    const u32 x = pixel & 0xffffu, y = pixel >> 16;
    if (x >= static_cast<u32>(film.film.width) || y >= static_cast<u32>(film.film.height)) return false;
    const auto p = static_cast<std::size_t>(image_index(film, pass, i));
    if (listed[p]) return false;
    listed[p] = true;
  }
  return true;
}

/// Whether the arrays hold what a film may.
bool are_true(const GrowingFilm& film, const Pass& pass, const Film& made) {
  const auto known = [](PixelState state) { return state <= PixelState::interpolated; };
  return all_flags(film.film.done) && all_flags(made.done) && std::ranges::all_of(film.states, known) &&
         are_pixels_of(film, pass);
}

}  // namespace

void write_growing_checkpoint(const std::filesystem::path& path, const GrowingFilm& film, const Pass& pass,
                              const Film& made, std::uint64_t key, const std::shared_ptr<Faults>& faults) {
  GrowingHeader header{};
  std::memcpy(header.magic, growing_magic, sizeof growing_magic);
  header.key = key;
  header.width = film.film.width, header.height = film.film.height;
  header.pass_width = pass.width, header.pass_height = pass.height;
  header.first_sample = pass.first_sample, header.sample_count = pass.sample_count;
  header.surfaces = pass.surfaces, header.costs = pass.costs;
  header.has_block_rays = !film.block_rays.empty();
  header.aovs = made.aovs.empty() ? 0 : made.layout.code();
  header.stage = film.stage, header.step = film.step;
  header.surfaces_seen = film.surfaces_seen;
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  for_each_array(film, pass.pixels, made, [&](const auto& array) {
    const std::uint64_t count = array.size();
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    bytes.append(reinterpret_cast<const char*>(array.data()), count * sizeof array[0]);
  });
  const std::uint64_t checksum = hash_bytes(bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  write_file(path, bytes, faults);
}

void read_growing_checkpoint(const std::filesystem::path& path, GrowingFilm& film, Pass& pass, Film& made,
                             std::uint64_t key) {
  const std::string bytes = read_checkpoint_bytes(path, most_bytes(film));
  const SceneError damaged = damaged_checkpoint(path);
  const UsageError other = other_checkpoint(path);
  GrowingHeader header{};
  std::uint64_t checksum = 0;
  if (bytes.size() < sizeof header + sizeof checksum) throw damaged;
  std::memcpy(&header, bytes.data(), sizeof header);
  const std::size_t end = bytes.size() - sizeof checksum;
  std::memcpy(&checksum, bytes.data() + end, sizeof checksum);
  if (checksum != hash_bytes(bytes.data(), end)) throw damaged;
  if (std::memcmp(header.magic, growing_magic, sizeof growing_magic) != 0 || header.key != key ||
      header.width != film.film.width || header.height != film.film.height)
    throw other;
  if (!is_frame_size(header.pass_width, header.pass_height)) throw damaged;
  pass.width = header.pass_width, pass.height = header.pass_height;
  pass.first_sample = header.first_sample, pass.sample_count = header.sample_count;
  pass.surfaces = header.surfaces != 0, pass.costs = header.costs != 0;
  if (pass.surfaces != (header.aovs != 0)) throw damaged;
  if (pass.surfaces && header.aovs != film.film.layout.code()) throw other;
  check_memory(path, film, pass, bytes.size());
  made = film_of_pass(film, pass, pass.surfaces);
  film.stage = header.stage, film.step = header.step;
  film.surfaces_seen = header.surfaces_seen;
  film.block_rays.resize(header.has_block_rays ? cost_blocks(header.width, header.height) : 0);
  std::size_t at = sizeof header;
  const auto take = [&](auto& array) {
    std::uint64_t count = 0;
    if (end - at < sizeof count) throw damaged;
    std::memcpy(&count, bytes.data() + at, sizeof count);
    at += sizeof count;
    const bool pixels = static_cast<const void*>(&array) == &pass.pixels;
    if (pixels && (count == 0 || count == made.done.size())) array.resize(count);
    if (count != array.size()) throw other;  // with AOVs or without
    if ((end - at) / sizeof array[0] < count) throw damaged;
    if (count > 0) std::memcpy(array.data(), bytes.data() + at, count * sizeof array[0]);
    at += count * sizeof array[0];
  };
  for_each_array(film, pass.pixels, made, take);
  if (at != end || !are_true(film, pass, made)) throw damaged;
  for (std::size_t p = 0; p < film.seen.size(); ++p)
    if (film.states[p] == PixelState::sampled) see(film, p);
}

}  // namespace sundog
