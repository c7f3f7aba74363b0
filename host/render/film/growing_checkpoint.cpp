// Checkpoints of frames made in passes: a header, then arrays, each behind its length, then a checksum.
#include <cstring>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "base/input.h"
#include "base/limits.h"
#include "render/film/growing_film.h"
#include "render/film/hash.h"

namespace sundog {
namespace {

constexpr char growing_magic[8] = {'S', 'U', 'N', 'D', 'O', 'G', 'P', '3'};

struct GrowingHeader {
  char magic[8];
  std::uint64_t key;
  std::int32_t width, height, pass_width, pass_height;
  std::uint32_t first_sample, sample_count, surfaces, costs, has_aovs, has_block_rays;
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
  header.has_aovs = !made.aovs.empty();
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
  const std::string bytes = read_input(path, most_frame_bytes);
  const SceneError damaged(path.string(), "",
                           "is no sundog checkpoint, or is damaged; remove it to start anew");
  const UsageError other(path.string() +
                         ": is a checkpoint of another scene or of other settings; remove it to start anew");
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
  made = film_of_pass(film, pass, header.has_aovs != 0);
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
  if (at != end || (pass.pixels.empty() && made.done.size() != film.taken.size())) throw damaged;
  for (std::size_t p = 0; p < film.seen.size(); ++p)
    if (film.states[p] == PixelState::sampled) see(film, p);
}

}  // namespace sundog
