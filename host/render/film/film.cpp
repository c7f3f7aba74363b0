#include "render/film/film.h"

#include <algorithm>

#include "base/error.h"

namespace sundog {

Film::Film(int width_, int height_, bool with_aovs) : width(width_), height(height_) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  sums.resize(pixels);
  weights.resize(pixels);
  done.resize(pixels);
  if (with_aovs) aovs.resize(3 * pixels);
}

namespace {

std::size_t offset(const Film& film, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) + static_cast<std::size_t>(x);
}

template <class T>
void copy_rows(const Film& film, const Tile& tile, std::size_t per_pixel, std::span<const T> from,
               std::vector<T>& to) {
  const std::size_t row = static_cast<std::size_t>(tile.width) * per_pixel;
  for (int y = 0; y < tile.height; ++y)
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * row), row,
                to.begin() + static_cast<std::ptrdiff_t>(offset(film, tile.x, tile.y + y) * per_pixel));
}

}  // namespace

bool Film::is_done(const Tile& tile) const {
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    const auto row = done.begin() + static_cast<std::ptrdiff_t>(offset(*this, tile.x, y));
    if (!std::all_of(row, row + tile.width, [](std::uint8_t d) { return d != 0; })) return false;
  }
  return true;
}

std::uint64_t Film::put(const Tile& tile, std::span<const float4> tile_sums,
                        std::span<const float> tile_weights, std::span<const float4> tile_aovs) {
  copy_rows(*this, tile, 1, tile_sums, sums);
  copy_rows(*this, tile, 1, tile_weights, weights);
  if (!tile_aovs.empty()) copy_rows(*this, tile, 3, tile_aovs, aovs);
  std::uint64_t fresh = 0;
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    const auto row = done.begin() + static_cast<std::ptrdiff_t>(offset(*this, tile.x, y));
    fresh += static_cast<std::uint64_t>(std::count(row, row + tile.width, std::uint8_t{0}));
    std::fill_n(row, tile.width, std::uint8_t{1});
  }
  return fresh;
}

Image Film::develop(int channels) const {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!done[i] || !(weights[i] > 0)) continue;
    float* pixel = image.data.data() + static_cast<std::size_t>(channels) * i;
    pixel[0] = sums[i].x / weights[i];
    pixel[1] = sums[i].y / weights[i];
    pixel[2] = sums[i].z / weights[i];
    if (channels == 4) pixel[3] = sums[i].w / weights[i];
  }
  return image;
}

const std::vector<std::string>& aov_names() {
  static const std::vector<std::string> names{"depth", "normal", "position", "albedo", "object", "material"};
  return names;
}

Image Film::develop_aov(const std::string& name) const {
  struct Place {
    const char* name;
    std::size_t vector;  // of the three a pixel
    bool scalar;         // its w; else its xyz
  };
  static constexpr Place places[] = {{"depth", 0, true},  {"normal", 0, false}, {"position", 1, false},
                                     {"object", 1, true}, {"albedo", 2, false}, {"material", 2, true}};
  const auto place =
      std::find_if(std::begin(places), std::end(places), [&](const Place& p) { return name == p.name; });
  if (place == std::end(places) || aovs.empty()) throw UsageError("no AOV is called '" + name + "'");
  Image image(width, height, place->scalar ? 1 : 3);
  for (std::size_t i = 0; i < done.size(); ++i) {
    if (!done[i]) continue;
    const float4& value = aovs[3 * i + place->vector];
    float* pixel = image.data.data() + static_cast<std::size_t>(image.channels) * i;
    if (place->scalar) {
      pixel[0] = value.w;
    } else {
      pixel[0] = value.x;
      pixel[1] = value.y;
      pixel[2] = value.z;
    }
  }
  return image;
}

}  // namespace sundog
