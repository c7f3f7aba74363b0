#include "render/film/growing_film.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sundog {
namespace {

// Pixels of a row of a pass over a list, in blocks of 4x4.
constexpr int list_width = 256, block = 4;

/// The bits of x and y in turn: neighbours in the order are neighbours in the image.
u32 morton(u32 x, u32 y) {
  const auto spread = [](u32 v) {
    v = (v | v << 8) & 0x00ff00ffu;
    v = (v | v << 4) & 0x0f0f0f0fu;
    v = (v | v << 2) & 0x33333333u;
    return (v | v << 1) & 0x55555555u;
  };
  return spread(x) | spread(y) << 1;
}

/// x + y * 65536 of a code of morton().
u32 place_of(u32 code) {
  const auto gather = [](u32 v) {
    v &= 0x55555555u;
    v = (v | v >> 1) & 0x33333333u;
    v = (v | v >> 2) & 0x0f0f0f0fu;
    v = (v | v >> 4) & 0x00ff00ffu;
    return (v | v >> 8) & 0xffffu;
  };
  return gather(code) | gather(code >> 1) << 16;
}

/// The square of pixel_errors() of a pixel with samples.
float squared_error(const GrowingFilm& film, std::size_t p) {
  const float4 &sum = film.film.sums[p], &before = film.earlier[p];
  const float weight = film.film.weights[p];
  if (!(weight > 0) || !(before.w > 0)) return std::numeric_limits<float>::infinity();
  const float now = 1 / weight, then = 1 / before.w;
  const float moved = std::abs(sum.x * now - before.x * then) + std::abs(sum.y * now - before.y * then) +
                      std::abs(sum.z * now - before.z * then);
  constexpr float darkest = 0.01f;  // below it nobody sees a relative error
  return moved * moved / std::sqrt(std::max((sum.x + sum.y + sum.z) * now, darkest));
}

/// After a pass over the pixel: one doubling may move it little by chance, so earlier ones count too.
void note_movement(GrowingFilm& film, std::size_t p) {
  const float square = squared_error(film, p), before = squares_of_doubling * film.moved[p];
  film.moved[p] = std::isfinite(before) ? (square + before) / 2 : square;
}

/// Of a pixel with one sample, which tells nothing of its error: how much the colours of the 3x3 pixels
/// around vary. Infinite where no other pixel is known.
void write_variance_around(const GrowingFilm& film, std::size_t p, float* variance) {
  const Film& whole = film.film;
  const int width = whole.width, x = static_cast<int>(p) % width, y = static_cast<int>(p) / width;
  float count = 0, sums[3] = {0, 0, 0}, squares[3] = {0, 0, 0};
  for (int v = std::max(0, y - 1); v <= std::min(whole.height - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
      const auto q =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
      if (!(whole.weights[q] > 0)) continue;
      const float4& sum = whole.sums[q];
      const float color[3] = {sum.x / whole.weights[q], sum.y / whole.weights[q], sum.z / whole.weights[q]};
      for (int c = 0; c < 3; ++c) sums[c] += color[c], squares[c] += color[c] * color[c];
      ++count;
    }
  for (int c = 0; c < 3; ++c)
    variance[c] = count > 1 ? std::max(0.0f, (squares[c] - sums[c] * sums[c] / count) / (count - 1))
                            : std::numeric_limits<float>::infinity();
}

}  // namespace

Pass list_pass(std::vector<u32> indices, int image_width, u32 first_sample, u32 sample_count) {
  const auto width = static_cast<u32>(image_width);
  for (u32& index : indices) index = morton(index % width, index / width);
  std::ranges::sort(indices);
  const int blocks = static_cast<int>((indices.size() + 15) / 16);
  const int columns = std::clamp(blocks, 1, list_width / block);
  Pass pass;
  pass.width = columns * block;
  pass.height = (blocks + columns - 1) / columns * block;
  pass.pixels.assign(static_cast<std::size_t>(pass.width) * static_cast<std::size_t>(pass.height), NO_PIXEL);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const int at = static_cast<int>(i / 16), in = static_cast<int>(i % 16);
    const int x = at % columns * block + in % block, y = at / columns * block + in / block;
    pass.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(pass.width) +
                static_cast<std::size_t>(x)] = place_of(indices[i]);
  }
  pass.first_sample = first_sample;
  pass.sample_count = sample_count;
  return pass;
}

GrowingFilm::GrowingFilm(int width, int height, bool with_aovs, std::size_t vectors)
    : film(width, height, with_aovs, vectors) {
  taken.resize(film.done.size());
  states.resize(film.done.size());
  earlier.resize(film.done.size());
  moved.assign(film.done.size(), std::numeric_limits<float>::infinity());
}

Film film_of_pass(const GrowingFilm& film, const Pass& pass, bool surfaces) {
  Film made(pass.width, pass.height, surfaces, film.film.vectors);
  if (!film.film.rays.empty()) made.rays.resize(made.done.size());
  return made;
}

std::int64_t image_index(const GrowingFilm& film, const Pass& pass, std::size_t i) {
  if (pass.pixels.empty()) return static_cast<std::int64_t>(i);
  const u32 pixel = pass.pixels[i];
  if (pixel == NO_PIXEL) return -1;
  return static_cast<std::int64_t>(pixel >> 16) * film.film.width +
         static_cast<std::int64_t>(pixel & 0xffffu);
}

void add_pass(GrowingFilm& film, const Pass& pass, const Film& made, bool complete) {
  Film& whole = film.film;
  for (std::size_t i = 0; i < made.done.size(); ++i) {
    const std::int64_t found = made.done[i] ? image_index(film, pass, i) : -1;
    if (found < 0) continue;
    const auto p = static_cast<std::size_t>(found);
    if (pass.surfaces && !whole.aovs.empty())
      std::copy_n(made.aovs.begin() + static_cast<std::ptrdiff_t>(made.vectors * i), made.vectors,
                  whole.aovs.begin() + static_cast<std::ptrdiff_t>(whole.vectors * p));
    film.surfaces_seen += pass.surfaces;
    if (film.states[p] == PixelState::empty) film.states[p] = PixelState::looked_at;
    if (pass.sample_count == 0) continue;
    film.earlier[p] = {whole.sums[p].x, whole.sums[p].y, whole.sums[p].z, whole.weights[p]};
    whole.sums[p] = made.sums[i];
    whole.weights[p] = made.weights[i];
    if (!whole.rays.empty()) whole.rays[p] = made.rays[i];
    whole.done[p] = 1;
    film.taken[p] = pass.first_sample + pass.sample_count;
    film.states[p] = PixelState::sampled;
    note_movement(film, p);
  }
  film.stage += complete;
}

std::vector<float> pixel_errors(const GrowingFilm& film) {
  std::vector<float> errors(film.taken.size());
  for (std::size_t p = 0; p < errors.size(); ++p)
    if (film.states[p] == PixelState::sampled) errors[p] = std::sqrt(squared_error(film, p));
  return errors;
}

Image develop_variance(const GrowingFilm& film) {
  Image image(film.film.width, film.film.height, 3);
  for (std::size_t p = 0; p < film.taken.size(); ++p) {
    if (film.states[p] != PixelState::sampled) continue;
    const float4 &sum = film.film.sums[p], &before = film.earlier[p];
    const float weight = film.film.weights[p];
    if (!(weight > 0 && before.w > 0)) {
      write_variance_around(film, p, &image.data[3 * p]);
      continue;
    }
    const float now[3] = {sum.x / weight, sum.y / weight, sum.z / weight};
    const float then[3] = {before.x / before.w, before.y / before.w, before.z / before.w};
    for (std::size_t c = 0; c < 3; ++c) image.data[3 * p + c] = (now[c] - then[c]) * (now[c] - then[c]);
  }
  return image;
}

Image develop_samples(const Film& film, const std::vector<u32>& taken) {
  Image image(film.width, film.height, 1);
  for (std::size_t p = 0; p < film.done.size(); ++p)
    if (film.done[p]) image.data[p] = taken.empty() ? film.weights[p] : static_cast<float>(taken[p]);
  return image;
}

}  // namespace sundog
