// A checkpoint is a header, then arrays, each preceded by its length, then a checksum, in the machine's own
// byte order (sundog runs on little-endian hosts).
#include "render/film/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <string>

#include "base/file.h"
#include "base/input.h"
#include "base/limits.h"
#include "render/film/hash.h"

namespace sundog {
namespace {

static_assert(std::endian::native == std::endian::little);

// The last two letters are the version.
constexpr char magic[8] = {'S', 'U', 'N', 'D', 'O', 'G', 'F', '1'};
constexpr std::size_t magic_name = 6;

struct Header {
  char magic[8];
  std::uint64_t key;
  std::int32_t width, height, pass_width, pass_height;
  std::uint32_t needs, aovs;  // the film's; aovs: code() of its layout, 0: none
  std::uint32_t first_sample, sample_count, surfaces, costs, has_block_rays;
  std::uint32_t stage, step, unused;
  std::uint64_t surfaces_seen;
};

constexpr std::uint32_t grows_code = 2;

std::uint32_t code_of(const FilmNeeds& needs) {
  return u32(needs.counts_rays) | (needs.grows ? grows_code : 0) | u32(needs.keeps_earlier) << 2;
}

std::uint32_t aovs_of(const FilmNeeds& needs) { return needs.shows_surfaces ? needs.layout.code() : 0; }

/// Calls visit(array) for each array of the file, in file order.
template <class Whole, class Pixels, class Visit>
void for_each_array(Whole& film, Pixels& pixels, Whole& made, const Visit& visit) {
  visit_samples(visit, film), visit(film.done);
  visit(film.taken), visit(film.states), visit(film.earlier), visit(film.moved), visit(film.block_rays);
  visit(pixels);
  visit_samples(visit, made), visit(made.done);
}

constexpr std::size_t sample_bytes = sizeof(float4) + sizeof(float) + 1;  // sums, weight, done flag

/// Throws SceneError if the file is too short for the pixels of its pass, before memory is allocated for
/// them.
void check_memory(const std::filesystem::path& path, const Film& film, const Pass& pass,
                  std::size_t file_bytes) {
  const auto pixels = static_cast<std::uintmax_t>(pass.width) * static_cast<std::uintmax_t>(pass.height);
  const std::size_t a_pixel = sample_bytes + (pass.surfaces ? sizeof(float4) * film.layout.vectors() : 0);
  if (pixels * a_pixel > file_bytes)
    throw SceneError(path.string(), "",
                     fmt::format("is a damaged checkpoint: it says {}x{} pixels in {} bytes", pass.width,
                                 pass.height, file_bytes),
                     Remedy::start_anew);
}

/// An upper bound for a checkpoint of this frame: a list of pixels is padded to rows of whole blocks.
std::uintmax_t most_bytes(const Film& film) {
  const std::uintmax_t of_film =
      sample_bytes + (film.shows_surfaces ? sizeof(float4) * film.layout.vectors() : 0) + sizeof(u32);
  constexpr std::uintmax_t of_growth = 4 * sizeof(u32) + sizeof(PixelState) + sizeof(float4);
  constexpr std::uintmax_t more = std::uintmax_t{1} << 16;
  return (film.grows ? 2 * of_film + of_growth : of_film) * (film.pixels() + more);
}

bool starts_with_magic(const std::string& bytes, std::size_t length) {
  return bytes.size() >= sizeof magic && std::memcmp(bytes.data(), magic, length) == 0;
}

UsageError other_checkpoint(const std::filesystem::path& path) {
  return UsageError(path.string() + ": is a checkpoint of another scene or of other settings",
                    Remedy::same_settings);
}

/// Throws UsageError, which names a setting that differs if the header has it, unless the checkpoint belongs
/// to the frame.
void check_is_of(const std::filesystem::path& path, const Header& header, const Film& film,
                 std::uint64_t key) {
  const auto refuse = [&](const std::string& why, Remedy remedy) {
    throw UsageError(path.string() + ": is a checkpoint of " + why, remedy);
  };
  if (header.width != film.width || header.height != film.height)
    refuse(fmt::format("{}x{} pixels, and the frame has {}x{}", header.width, header.height, film.width,
                       film.height),
           Remedy::same_settings);
  const bool grows = header.needs & grows_code;
  if (grows && !film.grows) refuse("a frame in passes", Remedy::in_passes);
  if (!grows && film.grows) refuse("a frame that is not in passes", Remedy::not_in_passes);
  if (header.needs != code_of(film) || header.aovs != aovs_of(film))
    refuse("a frame with other AOVs", Remedy::same_settings);
  if (header.key != key) throw other_checkpoint(path);
}

/// Returns the file's bytes without their checksum, after verifying it. Refuses a file longer than `most`
/// without reading it.
std::string checked_bytes(const std::filesystem::path& path, std::uintmax_t most) {
  std::error_code failed;
  if (std::filesystem::is_regular_file(path, failed)) {  // otherwise a pipe, which read_input() refuses
    std::string start(sizeof magic, ' ');
    std::ifstream(path, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
    if (starts_with_magic(start, magic_name) && !starts_with_magic(start, sizeof magic))
      throw UsageError(path.string() + ": is a checkpoint of another version of sundog",
                       Remedy::same_version);
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (!failed && size > most) throw other_checkpoint(path);
  }
  std::string bytes = read_input(path, most);
  std::uint64_t checksum = 0;
  if (!starts_with_magic(bytes, sizeof magic) || bytes.size() < sizeof(Header) + sizeof checksum)
    throw damaged_checkpoint(path);
  const std::size_t end = bytes.size() - sizeof checksum;
  std::memcpy(&checksum, bytes.data() + end, sizeof checksum);
  if (checksum != hash_bytes(bytes.data(), end)) throw damaged_checkpoint(path);
  bytes.resize(end);
  return bytes;
}

/// Whether the pixels are the whole image, or a list as list_pass() makes it, with each pixel once.
bool are_pixels_of(const Film& film, const Pass& pass) {
  if (pass.pixels.empty()) return pass.width == film.width && pass.height == film.height;
  if (!is_list_size(pass.width, pass.height)) return false;
  std::vector<bool> listed(film.pixels());
  for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
    const u32 pixel = pass.pixels[i];
    if (pixel == NO_PIXEL) continue;
    const u32 x = pixel & 0xffffu, y = pixel >> 16;
    if (x >= static_cast<u32>(film.width) || y >= static_cast<u32>(film.height)) return false;
    const auto p = static_cast<std::size_t>(image_index(film, pass, i));
    if (listed[p]) return false;
    listed[p] = true;
  }
  return true;
}

/// Whether the arrays hold only values that are possible in a film.
bool are_true(const Film& film, const Pass& pass, const Film& made) {
  const auto known = [](PixelState state) { return state <= PixelState::interpolated; };
  return all_flags(film.done) && all_flags(made.done) && std::ranges::all_of(film.states, known) &&
         (pass.is_none() ? pass.pixels.empty() : are_pixels_of(film, pass));
}

/// Copies the header's values to `film` and `pass`; false if no frame with this film can have them.
bool take_header(const Header& header, Film& film, Pass& pass) {
  film.stage = header.stage, film.step = header.step;
  film.surfaces_seen = header.surfaces_seen;
  pass.width = header.pass_width, pass.height = header.pass_height;
  pass.first_sample = header.first_sample, pass.sample_count = header.sample_count;
  pass.surfaces = header.surfaces != 0, pass.costs = header.costs != 0;
  if (pass.is_none()) return film.stage > 0;
  if (film.stage > 0 ? !film.grows : pass.first_sample > 0) return false;
  return is_frame_size(pass.width, pass.height) && (!pass.surfaces || film.shows_surfaces);
}

}  // namespace

SceneError damaged_checkpoint(const std::filesystem::path& path) {
  return {path.string(), "", "is no sundog checkpoint, or is damaged", Remedy::start_anew};
}

void write_checkpoint(const std::filesystem::path& path, const Film& film, const Pass& pass, const Film& made,
                      std::uint64_t key, const std::shared_ptr<Faults>& faults) {
  Header header{};
  std::memcpy(header.magic, magic, sizeof magic);
  header.key = key;
  header.width = film.width, header.height = film.height;
  header.pass_width = pass.width, header.pass_height = pass.height;
  header.needs = code_of(film), header.aovs = aovs_of(film);
  header.first_sample = pass.first_sample, header.sample_count = pass.sample_count;
  header.surfaces = pass.surfaces, header.costs = pass.costs;
  header.has_block_rays = !film.block_rays.empty();
  header.stage = film.stage, header.step = film.step;
  header.surfaces_seen = film.surfaces_seen;
  std::size_t size = sizeof header + sizeof(std::uint64_t);
  for_each_array(film, pass.pixels, made,
                 [&](const auto& array) { size += sizeof(std::uint64_t) + array.size() * sizeof array[0]; });
  std::string bytes;
  bytes.reserve(size);
  bytes.append(reinterpret_cast<const char*>(&header), sizeof header);
  for_each_array(film, pass.pixels, made, [&](const auto& array) {
    const std::uint64_t count = array.size();
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    bytes.append(reinterpret_cast<const char*>(array.data()), count * sizeof array[0]);
  });
  const std::uint64_t checksum = hash_bytes(bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  write_file(path, bytes, faults);
}

void read_checkpoint(const std::filesystem::path& path, Film& film, Pass& pass, Film& made,
                     std::uint64_t key) {
  const std::string bytes = checked_bytes(path, most_bytes(film));
  const SceneError damaged = damaged_checkpoint(path);
  Header header{};
  std::memcpy(&header, bytes.data(), sizeof header);
  check_is_of(path, header, film, key);
  if (!take_header(header, film, pass)) throw damaged;
  check_memory(path, film, pass, bytes.size());
  if (film.stage > 0) film.allocate();
  film.block_rays.resize(header.has_block_rays ? cost_blocks(header.width, header.height) : 0);
  made = pass.is_none() ? Film() : film_of_pass(film, pass);
  std::size_t at = sizeof header;
  const auto take = [&](auto& array) {
    std::uint64_t count = 0;
    if (bytes.size() - at < sizeof count) throw damaged;
    std::memcpy(&count, bytes.data() + at, sizeof count);
    at += sizeof count;
    const bool is_list = static_cast<const void*>(&array) == &pass.pixels;
    if (is_list && (count == 0 || count == made.done.size())) array.resize(count);
    if (count != array.size() || (bytes.size() - at) / sizeof array[0] < count) throw damaged;
    if (count > 0) std::memcpy(array.data(), bytes.data() + at, count * sizeof array[0]);
    at += count * sizeof array[0];
  };
  for_each_array(film, pass.pixels, made, take);
  if (at != bytes.size() || !are_true(film, pass, made)) throw damaged;
  for (std::size_t p = 0; p < film.states.size(); ++p)
    if (film.states[p] == PixelState::sampled) see(film, p);
}

}  // namespace sundog
