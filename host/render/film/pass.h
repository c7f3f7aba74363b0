// A frame is rendered in passes, each of which adds some samples to some pixels; a plain frame needs one.
// Between passes the film is complete, and the next pass follows from it alone.
#pragma once
#include <cstdint>
#include <vector>

#include "render/film/film.h"

namespace sundog {

/// One pass: samples [first_sample, first_sample + sample_count) of its pixels; with `surfaces` also AOVs,
/// with `costs` also the rays that blocks of pixels take. It is rendered as its own film of width x height
/// pixels.
struct Pass {
  int width = 0, height = 0;
  std::vector<u32> pixels;  // image pixels, x | y << 16, or NO_PIXEL; empty: the whole image
  u32 first_sample = 0, sample_count = 0;
  bool surfaces = false, costs = false;  // `surfaces`: AOVs; first samples find the surfaces
  bool is_none() const { return width == 0 && height == 0; }
};

/// The pixels of an image, x | y << 16, in an order that keeps neighbours together.
std::vector<u32> all_pixels(int image_width, int image_height);

/// The pixels of all_pixels() whose value exceeds the limit of their 4x4 block. `values` is row by row.
std::vector<u32> pixels_above(const std::vector<float>& limits, const std::vector<float>& values,
                              int image_width, int image_height);

/// A pass over some of all_pixels(), in their order: each run of 16 becomes a 4x4 square of the pass, which
/// one work-item renders.
Pass list_pass(const std::vector<u32>& pixels, u32 first_sample, u32 sample_count);

/// Whether list_pass() can make a pass of this size.
bool is_list_size(int width, int height);

/// A pass's pixels in the order of all_pixels(), without padding.
std::vector<u32> pixels_of(const Pass& pass);

/// Edge of the pixel blocks whose rays a pass with `costs` counts. No device renders pixels of two blocks in
/// one work-item.
constexpr int cost_block = 4;
inline u32 cost_blocks_along(int size) { return static_cast<u32>((size + cost_block - 1) / cost_block); }
inline std::size_t cost_blocks(int width, int height) {
  return std::size_t{cost_blocks_along(width)} * cost_blocks_along(height);
}

/// Pixels per thread task: with fewer, waking another thread costs more than it saves.
constexpr std::size_t pixels_at_once = 1 << 17;

/// A film of the pass's size whose pixels are not done.
Film film_of_pass(const Film& film, const Pass& pass);

/// The image's pixel index (y * width + x) for pixel `i` of the pass; -1: none.
std::int64_t image_index(const Film& film, const Pass& pass, std::size_t i);

/// A list pass visits pixels in scattered memory, so each is prefetched this many pixels ahead.
constexpr std::size_t pixels_ahead = 24;

/// Prefetches the film's sums and weight for pixel `i` of a list pass, if it exists.
void prefetch_sums(const Film& film, const Pass& pass, std::size_t i);

/// Copies a pass's finished pixels into the film. If `complete`, all are finished and the next pass may be
/// planned; otherwise the film is only for display. An empty film takes over the arrays of a full-image pass.
void add_pass(Film& film, const Pass& pass, Film made, bool complete);

/// Estimated standard error of each pixel's colour, from how far the last doubling of samples moved it
/// (Dammertz et al. 2010): the sum over channels, divided by the fourth root of the colour's sum, a
/// compromise between measured and perceived error. Infinite if unknown, 0 without samples.
std::vector<float> pixel_errors(const Film& film);

/// Doubling the samples multiplies the squared error by this (measured: edges and smooth surfaces, Sobol).
/// `moved` from earlier doublings is rescaled by it.
constexpr float squares_of_doubling = 0.27f;

/// Squared error relative to one sample's; `samples` is rounded down to a power of two.
float share_of_squares(u32 samples);

/// Computes the pixel's `seen` and `moved_by_one` from its sums, weight, samples and movement.
void see(Film& film, std::size_t pixel);

/// Variance of each pixel's colour from the same difference, per channel, unbiased. With one sample: the
/// variance of the colours of the 3x3 pixels around it. 0 without samples, infinite if unknown.
Image develop_variance(const Film& film);

}  // namespace sundog
