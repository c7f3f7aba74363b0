// Adds finished passes to the film, and estimates each pixel's error from how far its last samples moved its
// mean.
#include "render/film/pass.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace sundog {
namespace {

/// The mean of a pixel's samples with missing alpha mixed in, which leaves the light unchanged: two pixels of
/// equal colour but different coverage differ.
Color watched(const float4& sum, float weight) {
  Color color = mean_of(sum, weight);
  const float clear = weight > 0 ? 1 - sum.w / weight : 0;
  color.r += clear;
  color.g -= clear;
  return color;
}

/// The square of pixel_errors() for a pixel whose watched() colour was `then` before its last samples.
float squared_error(const Color& now, const Color& then) {
  const float moved = std::abs(now.r - then.r) + std::abs(now.g - then.g) + std::abs(now.b - then.b);
  return moved * moved / std::sqrt(seen_light(now));
}

float squared_error(const Film& film, std::size_t p) {
  const float weight = film.weights[p];
  const float4& before = film.earlier[p];
  if (!(weight > 0 && before.w > 0)) return std::numeric_limits<float>::infinity();
  return squared_error(mean_of(film.sums[p], weight), mean_of(before, before.w));
}

Seen seen_of(const Color& color) {
  return Seen{color.r, color.g, color.b, color.r * color.r + color.g * color.g + color.b * color.b};
}

float moved_by_one(float moved, u32 taken) { return taken > 1 ? moved / share_of_squares(taken) : 0; }

/// Copies the samples of pixel `i` of a pass to pixel `p` of the film.
void add_samples(Film& film, const Pass& pass, const Film& made, std::size_t i, std::size_t p) {
  const float4 sum = made.sums[i], before = film.sums[p];
  const float weight = made.weights[i], weight_before = film.weights[p];
  const u32 taken = pass.first_sample + pass.sample_count;
  const Color color = watched(sum, weight);
  if (weight > 0 && weight_before > 0) {
    // One doubling may move the mean little by chance, so earlier ones count too.
    const Seen& then = film.seen[p];
    const float square = squared_error(color, {then[0], then[1], then[2]});
    const float earlier = squares_of_doubling * film.moved[p];
    film.moved[p] = std::isfinite(earlier) ? (square + earlier) / 2 : square;
  }
  if (weight_before != 0 && !film.earlier.empty())
    film.earlier[p] = {before.x, before.y, before.z, weight_before};
  film.seen[p] = seen_of(color);
  film.moved_by_one[p] = moved_by_one(film.moved[p], taken);
  film.sums[p] = sum;
  film.weights[p] = weight;
  if (!film.rays.empty()) film.rays[p] = made.rays[i];
  film.taken[p] = taken;
  if (pass.first_sample > 0) return;
  film.done[p] = 1;
  film.states[p] = PixelState::sampled;
}

/// Copies pixel `i` of a pass to pixel `p` of the film.
void add_pixel(Film& film, const Pass& pass, const Film& made, std::size_t i, std::size_t p) {
  const std::size_t vectors = film.layout.vectors();
  if (pass.surfaces && !film.aovs.empty())
    std::copy_n(made.aovs.begin() + static_cast<std::ptrdiff_t>(vectors * i), vectors,
                film.aovs.begin() + static_cast<std::ptrdiff_t>(vectors * p));
  if (pass.sample_count > 0)
    add_samples(film, pass, made, i, p);
  else if (film.states[p] == PixelState::empty)
    film.states[p] = PixelState::looked_at;
}

void prefetch(const Film& film, const Pass& pass, std::size_t i) {
  if (pass.pixels.empty() || i >= pass.pixels.size() || pass.pixels[i] == NO_PIXEL) return;
  prefetch_sums(film, pass, i);
  const auto p = static_cast<std::size_t>(image_index(film, pass, i));
  __builtin_prefetch(&film.seen[p], 1);
  __builtin_prefetch(&film.moved[p], 1);
  __builtin_prefetch(&film.moved_by_one[p], 1);
  __builtin_prefetch(&film.taken[p], 1);
}

/// Sums the rays of each block of cost_block x cost_block pixels.
std::vector<u32> add_up_blocks(const std::vector<u32>& rays, int width, int height) {
  const int columns = (width + cost_block - 1) / cost_block;
  std::vector<u32> sums(cost_blocks(width, height));
  const u32* pixel = rays.data();
  for (int y = 0; y < height; ++y) {
    u32* sum = &sums[static_cast<std::size_t>(y / cost_block * columns)];
    for (int x = 0; x < width; x += cost_block, ++sum)
      for (const u32* end = pixel + std::min(cost_block, width - x); pixel < end; ++pixel) *sum += *pixel;
  }
  return sums;
}

/// Moves the arrays of a full-image pass into an empty film.
void take_pixels(Film& film, const Pass& pass, Film made) {
  film.sums = std::move(made.sums), film.weights = std::move(made.weights), film.done = std::move(made.done);
  if (pass.costs) film.block_rays = add_up_blocks(made.rays, film.width, film.height);
  if (film.counts_rays) film.rays = std::move(made.rays);
  if (pass.surfaces && film.shows_surfaces) film.aovs = std::move(made.aovs);
  film.allocate();
  if (!film.grows) return;
  if (pass.surfaces)
    film.surfaces_seen += static_cast<std::uint64_t>(std::ranges::count(film.done, std::uint8_t{1}));
  for (std::size_t p = 0; p < film.done.size(); ++p) {
    if (!film.done[p]) continue;
    film.taken[p] = pass.sample_count;
    film.states[p] = PixelState::sampled;
    see(film, p);
  }
}

/// Writes the variance of the colours of the 3x3 pixels around `p`, whose one sample says nothing about its
/// error. Infinite if no other pixel is known.
void write_variance_around(const Film& film, std::size_t p, float* variance) {
  const int width = film.width, x = static_cast<int>(p) % width, y = static_cast<int>(p) / width;
  float count = 0, sums[3] = {0, 0, 0}, squares[3] = {0, 0, 0};
  for (int v = std::max(0, y - 1); v <= std::min(film.height - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
      const auto q =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
      if (!(film.weights[q] > 0)) continue;
      const float4& sum = film.sums[q];
      const float color[3] = {sum.x / film.weights[q], sum.y / film.weights[q], sum.z / film.weights[q]};
      for (int c = 0; c < 3; ++c) sums[c] += color[c], squares[c] += color[c] * color[c];
      ++count;
    }
  for (int c = 0; c < 3; ++c)
    variance[c] = count > 1 ? std::max(0.0f, (squares[c] - sums[c] * sums[c] / count) / (count - 1))
                            : std::numeric_limits<float>::infinity();
}

}  // namespace

Film film_of_pass(const Film& film, const Pass& pass) {
  Film made(pass.width, pass.height,
            {.layout = film.layout,
             .shows_surfaces = pass.surfaces,
             .counts_rays = film.counts_rays || pass.costs});
  made.allocate();
  return made;
}

void prefetch_sums(const Film& film, const Pass& pass, std::size_t i) {
  if (pass.pixels.empty() || i >= pass.pixels.size()) return;  // an image's rows are contiguous
  const std::int64_t p = image_index(film, pass, i);
  if (p < 0) return;
  __builtin_prefetch(&film.sums[static_cast<std::size_t>(p)], 1);
  __builtin_prefetch(&film.weights[static_cast<std::size_t>(p)], 1);
}

std::int64_t image_index(const Film& film, const Pass& pass, std::size_t i) {
  if (pass.pixels.empty()) return static_cast<std::int64_t>(i);
  const u32 pixel = pass.pixels[i];
  if (pixel == NO_PIXEL) return -1;
  return static_cast<std::int64_t>(pixel >> 16) * film.width + static_cast<std::int64_t>(pixel & 0xffffu);
}

float share_of_squares(u32 samples) {
  static const std::array<float, 32> powers = [] {
    std::array<float, 32> list{};
    for (std::size_t i = 0; i < list.size(); ++i)
      list[i] = static_cast<float>(std::pow(squares_of_doubling, static_cast<double>(i)));
    return list;
  }();
  return powers[static_cast<std::size_t>(std::bit_width(samples) - 1)];
}

void see(Film& film, std::size_t pixel) {
  film.seen[pixel] = seen_of(watched(film.sums[pixel], film.weights[pixel]));
  film.moved_by_one[pixel] = moved_by_one(film.moved[pixel], film.taken[pixel]);
}

void add_pass(Film& film, const Pass& pass, Film made, bool complete) {
  film.stage += complete;
  if (film.sums.empty()) {
    if (pass.pixels.empty() && pass.sample_count > 0) return take_pixels(film, pass, std::move(made));
    film.allocate();
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, made.done.size(), pixels_at_once),
                    [&](const auto& pixels) {
                      for (std::size_t i = pixels.begin(); i != pixels.end(); ++i) {
                        prefetch(film, pass, i + pixels_ahead);
                        const std::int64_t found = made.done[i] ? image_index(film, pass, i) : -1;
                        if (found >= 0) add_pixel(film, pass, made, i, static_cast<std::size_t>(found));
                      }
                    });
  if (pass.surfaces && pass.first_sample == 0)
    for (std::size_t i = 0; i < made.done.size(); ++i)
      film.surfaces_seen += made.done[i] && image_index(film, pass, i) >= 0;
}

std::vector<float> pixel_errors(const Film& film) {
  std::vector<float> errors(film.taken.size());
  for (std::size_t p = 0; p < errors.size(); ++p)
    if (film.states[p] == PixelState::sampled) errors[p] = std::sqrt(squared_error(film, p));
  return errors;
}

Image develop_variance(const Film& film) {
  Image image(film.width, film.height, 3);
  for (std::size_t p = 0; p < film.taken.size(); ++p) {
    if (film.states[p] != PixelState::sampled) continue;
    const float4 &sum = film.sums[p], &before = film.earlier[p];
    const float weight = film.weights[p];
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

}  // namespace sundog
