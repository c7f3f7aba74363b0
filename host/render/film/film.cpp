// Allocates a film's arrays, stores finished tiles, and develops them into the image and AOVs. The table
// `places` locates each AOV among a pixel's vectors.
#include "render/film/film.h"

#include <algorithm>
#include <array>
#include <limits>

#include "base/error.h"
#include "render/film/group_names.h"
#include "render/film/light_parts.h"
#include "render/film/pass.h"

namespace sundog {

Film::Film(int width_, int height_, bool with_aovs, AovLayout layout_)
    : Film(width_, height_, FilmNeeds{.layout = layout_, .shows_surfaces = with_aovs}) {
  allocate();
}

Film Film::with_aovs(int width, int height, const std::vector<std::string>& names) {
  Film film(width, height, film_needs(names));
  film.allocate();
  return film;
}

void Film::allocate() {
  const std::size_t all = pixels();
  sums.resize(all), weights.resize(all), done.resize(all);
  if (shows_surfaces) aovs.resize(layout.vectors() * all);
  if (counts_rays) rays.resize(all);
  if (!grows) return;
  taken.resize(all), states.resize(all), seen.resize(all), moved_by_one.resize(all);
  moved.resize(all, std::numeric_limits<float>::infinity());
  if (keeps_earlier) earlier.resize(all);
}

namespace {

std::size_t offset(const Film& film, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) + static_cast<std::size_t>(x);
}

template <class T>
void copy_rows(const Film& film, const Tile& tile, const std::vector<T>& from, std::vector<T>& to) {
  if (from.empty()) return;
  const std::size_t per_pixel = to.size() / film.pixels();
  const std::size_t row = static_cast<std::size_t>(tile.width) * per_pixel;
  for (int y = 0; y < tile.height; ++y)
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * row), row,
                to.begin() + static_cast<std::ptrdiff_t>(offset(film, tile.x, tile.y + y) * per_pixel));
}

enum class AovKind { surface, matte, light };

/// An AOV's place in a pixel's vectors: `count` floats from `first` among the vectors of its kind.
struct AovPlace {
  const char* name;
  std::size_t first, count;
  AovKind kind = AovKind::surface;
};
constexpr std::size_t matte_floats = std::size_t{2} * MATTE_RANKS;

#define NUMBER_OF_PART(name) part_##name,
enum : std::size_t { LIGHT_PARTS(NUMBER_OF_PART) all_parts };
static_assert(all_parts == LIGHT_PART_COUNT && 3 * all_parts <= std::size_t{4} * LIGHT_VECTORS);
#define PLACE_OF_PART(name) {#name, 3 * part_##name, 3, AovKind::light},

constexpr AovPlace places[] = {LIGHT_PARTS(PLACE_OF_PART){"depth", 3, 1},
                               {motion_aov, 3, 5},  // find_motion() computes it from depth and object
                               {"normal", 0, 3},
                               {"position", 4, 3},
                               {"albedo", 8, 3},
                               {"object", 7, 1},
                               {"material", 11, 1},
                               {feature_albedo, 12, 3},
                               {feature_normal, 16, 3},
                               {"geometric_normal", 20, 3},
                               {"march_steps", 23, 1},
                               {"uv", 24, 2},
                               {"crypto_object", 0, matte_floats, AovKind::matte},
                               {"crypto_material", matte_floats, matte_floats, AovKind::matte}};

/// Converts a pixel's pairs of (id + 1, sum of shares) to (id, coverage), sorted by coverage, then by id; an
/// unused pair has id -1.
void rank_mattes(float* pairs, float weight) {
  struct Pair {
    float id, share;
  };
  std::array<Pair, MATTE_RANKS> ranks;
  for (std::size_t k = 0; k < ranks.size(); ++k)
    ranks[k] = {pairs[2 * k] - 1, weight > 0 ? pairs[2 * k + 1] / weight : 0};
  for (Pair& rank : ranks)
    if (!(rank.id >= 0) || !(rank.share > 0)) rank = {-1, 0};
  std::ranges::sort(ranks, [](const Pair& a, const Pair& b) {
    return a.share != b.share ? a.share > b.share : a.id < b.id;
  });
  for (std::size_t k = 0; k < ranks.size(); ++k)
    pairs[2 * k] = ranks[k].id, pairs[2 * k + 1] = ranks[k].share;
}

bool holds(const AovLayout& layout, const AovPlace& place) {
  if (place.kind == AovKind::surface) return place.first < 4 * layout.surfaces;
  return place.kind == AovKind::matte ? layout.mattes : layout.light;
}

std::size_t first_float(const AovLayout& layout, const AovPlace& place) {
  const std::size_t of_mattes = 4 * layout.surfaces;
  if (place.kind == AovKind::surface) return place.first;
  return place.first + (place.kind == AovKind::matte ? of_mattes : 4 * layout.first_light());
}

/// One channel of the light parts of pixel `i`, which has samples.
PartValues parts_of(const Film& film, std::size_t i, std::size_t channel) {
  const auto* sums = reinterpret_cast<const float*>(&film.sums[i]);
  const auto* of_parts =
      reinterpret_cast<const float*>(&film.aovs[film.layout.vectors() * i + film.layout.first_light()]);
  PartValues parts;
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k] = of_parts[3 * k + channel] / film.weights[i];
  fit_sum(parts, sums[channel] / film.weights[i]);
  return parts;
}

const AovPlace* find_place(const std::string& name) {
  if (is_light_group(name)) return &places[number_of_group(name)];  // groups replace the parts of light
  const auto* place =
      std::find_if(std::begin(places), std::end(places), [&](const AovPlace& p) { return name == p.name; });
  return place == std::end(places) ? nullptr : place;
}

}  // namespace

bool Film::is_done(const Tile& tile) const {
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    const auto row = done.begin() + static_cast<std::ptrdiff_t>(offset(*this, tile.x, y));
    if (!std::all_of(row, row + tile.width, [](std::uint8_t d) { return d != 0; })) return false;
  }
  return true;
}

std::uint64_t Film::put(const Tile& tile, const Samples& made) {
  visit_samples([&](const auto& from, auto& to) { copy_rows(*this, tile, from, to); }, made, *this);
  std::uint64_t fresh = 0;
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    const auto row = done.begin() + static_cast<std::ptrdiff_t>(offset(*this, tile.x, y));
    fresh += static_cast<std::uint64_t>(std::count(row, row + tile.width, std::uint8_t{0}));
    std::fill_n(row, tile.width, std::uint8_t{1});
  }
  return fresh;
}

Film Film::cut(const Tile& area) const {
  Film part(area.width, area.height, *this);
  part.grows = part.keeps_earlier = false;
  visit_samples(
      [&](const auto& from, auto& to) { to = cut_pixels(from, width, area, from.size() / pixels()); }, *this,
      part);
  part.done = cut_pixels(done, width, area);
  part.taken = cut_pixels(taken, width, area);
  part.stage = stage, part.surfaces_seen = surfaces_seen;
  return part;
}

const std::vector<std::string>& aov_names() {
  static const auto& names = *new const auto([] {
    std::vector<std::string> all;
    for (const AovPlace& place : places) all.emplace_back(place.name);
    for (const char* of_samples : {"samples", "rays", "variance"}) all.emplace_back(of_samples);
    return all;
  }());
  return names;
}

bool show_surfaces(const std::vector<std::string>& names) {
  return std::ranges::any_of(names, [](const std::string& name) { return find_place(name) != nullptr; });
}

AovLayout aov_layout(const std::vector<std::string>& names) {
  AovLayout layout;
  for (const std::string& name : names) {
    const AovPlace* place = find_place(name);
    if (!place) continue;
    layout.mattes |= place->kind == AovKind::matte;
    layout.light |= place->kind == AovKind::light;
    layout.groups |= is_light_group(name);
    for (const std::size_t more : {feature_aov_vectors, all_aov_vectors})
      if (place->kind == AovKind::surface && place->first >= 4 * layout.surfaces) layout.surfaces = more;
  }
  return layout;
}

std::size_t aov_channels(const std::string& name) {
  const AovPlace* place = find_place(name);
  return place ? place->count : name == "variance" ? 3 : 1;
}

bool shows_features(const std::vector<std::string>& names) {
  return std::ranges::count(names, feature_albedo) + std::ranges::count(names, feature_normal) > 0;
}

bool is_light(const std::string& aov) {
  const AovPlace* place = find_place(aov);
  return place && place->kind == AovKind::light;
}

bool counts_rays(const std::vector<std::string>& names) { return std::ranges::count(names, "rays") > 0; }

FilmNeeds film_needs(const std::vector<std::string>& names) {
  return {
      .layout = aov_layout(names), .shows_surfaces = show_surfaces(names), .counts_rays = counts_rays(names)};
}

std::size_t film_bytes(const std::vector<std::string>& names) {
  const std::size_t aovs = show_surfaces(names) ? sizeof(float4) * aov_layout(names).vectors() : 0;
  return sizeof(float4) + sizeof(float) + 1 + aovs + (counts_rays(names) ? sizeof(u32) : 0);
}

Image Film::develop(int channels) const {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!done[i] || !(weights[i] > 0)) continue;
    float* pixel = image.data.data() + static_cast<std::size_t>(channels) * i;
    pixel[0] = sums[i].x / weights[i];
    pixel[1] = sums[i].y / weights[i];
    pixel[2] = sums[i].z / weights[i];
    // If no float parts sum to exactly this colour, the image shows their sum, so that the two agree.
    for (std::size_t c = 0; c < 3 && layout.light && !aovs.empty(); ++c)
      pixel[c] = sum_of(parts_of(*this, i, c));
    if (channels == 4) pixel[3] = sums[i].w / weights[i];
  }
  return image;
}

/// An image of one number per finished pixel.
template <class T>
static Image pixel_numbers(const Film& film, const std::vector<T>& numbers) {
  Image image(film.width, film.height, 1);
  for (std::size_t i = 0; i < film.done.size(); ++i)
    if (film.done[i]) image.data[i] = static_cast<float>(numbers[i]);
  return image;
}

Image Film::develop_aov(const std::string& name) const {
  if (name == "rays" && !rays.empty()) return pixel_numbers(*this, rays);
  if (name == "samples") return taken.empty() ? pixel_numbers(*this, weights) : pixel_numbers(*this, taken);
  if (name == "variance" && !earlier.empty()) return develop_variance(*this);
  const AovPlace* place = find_place(name);
  if (!place || aovs.empty() || !holds(layout, *place)) throw UsageError("no AOV is called '" + name + "'");
  Image image(width, height, static_cast<int>(place->count));
  const auto* floats = reinterpret_cast<const float*>(aovs.data());
  const std::size_t first = first_float(layout, *place);
  for (std::size_t i = 0; i < done.size(); ++i) {
    if (!done[i]) continue;
    float* values = image.data.data() + place->count * i;
    std::copy_n(floats + 4 * layout.vectors() * i + first, place->count, values);
    if (place->kind == AovKind::matte) rank_mattes(values, weights[i]);
    if (place->kind == AovKind::light)
      for (std::size_t c = 0; c < 3; ++c)
        values[c] = weights[i] > 0 ? parts_of(*this, i, c)[place->first / 3] : 0;
  }
  return image;
}

Color Film::balanced_mean(std::size_t pixel, std::span<const glm::vec3> factors) const {
  std::array<float, 3> color{};
  for (std::size_t c = 0; c < 3; ++c) {
    PartValues parts = parts_of(*this, pixel, c);
    for (std::size_t k = 0; k < std::min(parts.size(), factors.size()); ++k)
      parts[k] *= factors[k][static_cast<int>(c)];
    color[c] = sum_of(parts);
  }
  return {color[0], color[1], color[2]};
}

}  // namespace sundog
