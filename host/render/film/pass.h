// A frame is made in passes: some of its pixels, some of their samples at a time; a plain frame in one.
// Between two passes the film is whole, and what comes next follows from it alone.
#pragma once
#include <cstdint>
#include <vector>

#include "render/film/film.h"

namespace sundog {

/// One pass: samples [first_sample, first_sample + sample_count) of its pixels, with `surfaces` what the
/// camera sees first there, with `costs` the rays that blocks of pixels take. It is rendered as a film of its
/// own, of width x height pixels.
struct Pass {
  int width = 0, height = 0;
  std::vector<u32> pixels;  // of the image, x | y << 16, or NO_PIXEL; empty: the image's own
  u32 first_sample = 0, sample_count = 0;
  bool surfaces = false, costs = false;  // `surfaces`: AOVs, of which first samples look for the surfaces
  bool is_none() const { return width == 0 && height == 0; }
};

/// The pixels of an image, x | y << 16, in an order in which neighbours stay together.
std::vector<u32> all_pixels(int image_width, int image_height);

/// The pixels of all_pixels() whose value is above the limit of their block of 4x4. Values are row by row.
std::vector<u32> pixels_above(const std::vector<float>& limits, const std::vector<float>& values,
                              int image_width, int image_height);

/// A pass over some of all_pixels(), in their order: each run of 16 is a square of 4x4 in the pass, the
/// pixels that a work-item takes together.
Pass list_pass(const std::vector<u32>& pixels, u32 first_sample, u32 sample_count);

/// Whether list_pass() may make a pass of that size.
bool is_list_size(int width, int height);

/// The pixels of a pass in that order.
std::vector<u32> pixels_of(const Pass& pass);

/// The edge of the blocks of pixels whose rays a pass with `costs` counts: no device takes pixels of two of
/// them together.
constexpr int cost_block = 4;
inline u32 cost_blocks_along(int size) { return static_cast<u32>((size + cost_block - 1) / cost_block); }
inline std::size_t cost_blocks(int width, int height) {
  return std::size_t{cost_blocks_along(width)} * cost_blocks_along(height);
}

/// Pixels that a thread takes at once: below, waking another costs more than it saves.
constexpr std::size_t pixels_at_once = 1 << 17;

/// A film of the pass's size whose pixels are not done.
Film film_of_pass(const Film& film, const Pass& pass);

/// The image's pixel (y * width + x) that pixel `i` of the pass stands for; -1: none.
std::int64_t image_index(const Film& film, const Pass& pass, std::size_t i);

/// The memory of a list's pixels lies about: that of one so many later is asked for in time.
constexpr std::size_t pixels_ahead = 24;

/// Asks for sums and weights of pixel `i` of the pass, if there is one.
void prefetch_sums(const Film& film, const Pass& pass, std::size_t i);

/// Puts the pixels of a pass that are done in their places. `complete`: all are, and the next pass may be
/// planned; else the film is good to be looked at only. A film without pixels takes the arrays of a pass over
/// all of them.
void add_pass(Film& film, const Pass& pass, Film made, bool complete);

/// The estimated standard error of each pixel's colour: by how far a pass that doubled the samples moved it
/// (Dammertz and others 2010). Summed over the channels and divided by the fourth root of their sum, which
/// lies between the errors that are measured and those that are seen. Infinite where nothing is known, 0
/// where no sample is.
std::vector<float> pixel_errors(const Film& film);

/// The squared error of twice as many samples is this share of that of so many: edges and smooth surfaces
/// under a Sobol sequence, by trial. Earlier doublings speak of a pixel's `moved` in this measure.
constexpr float squares_of_doubling = 0.27f;

/// By how many times that is smaller than with one sample; of 2^i + k samples as of 2^i.
float share_of_squares(u32 samples);

/// Sets the pixel's `seen` and `moved_by_one` by its sums, weight, samples and movement.
void see(Film& film, std::size_t pixel);

/// The variance of each pixel's colour, by the same difference: unbiased, of each channel. Of a pixel with
/// one sample, that of the colours of the 3x3 pixels around. 0 where no sample is, infinite where nothing is
/// known.
Image develop_variance(const Film& film);

}  // namespace sundog
