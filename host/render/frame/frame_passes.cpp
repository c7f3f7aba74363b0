// The passes of a frame: coarse ones first where somebody waits, then its own, each planned from those
// before.
#include <algorithm>

#include "render/frame/frame.h"
#include "render/plan/subsample.h"

namespace sundog {
namespace {

/// A coarse pass is complete: its picture may be looked at. Returns the block of the next one; 0: none.
int take_coarse(Frame& frame) {
  CoarsePasses& coarse = frame.coarse;
  coarse.picture.take(frame.pass, frame.pass_film, frame.film.width, frame.film.height, coarse.block);
  ++coarse.count;
  const double blocks = static_cast<double>(coarse.picture.colors.size());
  coarse.pixel_seconds = expected_pixel_seconds(frame.since_pass.seconds() / blocks, coarse.pixel_seconds);
  return next_block(coarse.block, coarse.pixel_seconds, frame.film.pixels());
}

/// The pass that comes after the one that is complete.
std::optional<Pass> following_pass(Frame& frame) {
  CoarsePasses& coarse = frame.coarse;
  if (coarse.block == 0) {
    if (frame.film.stage == 0)
      coarse.pixel_seconds = frame.since_pass.seconds() / static_cast<double>(frame.film.pixels());
    add_pass(frame.film, frame.pass, std::move(frame.pass_film), true);
  } else {
    coarse.block = take_coarse(frame);
    if (coarse.block > 0) return coarse_pass(frame.film.width, frame.film.height, coarse.block);
  }
  return next_pass(frame.film, frame.plan, frame.pass);
}

/// Puts what is done of the pass in hand into the film of the passes before.
Film joined(const Frame& frame, Film film, Film made) {
  if (!made.done.empty() && frame.coarse.block == 0) add_pass(film, frame.pass, std::move(made), false);
  if (film.sums.empty()) film.allocate();
  if (frame.plan.settings.subsample && !frame.pass.is_none()) interpolate_rest(film);
  return film;
}

}  // namespace

void continue_pass(Frame& frame) {
  frame.since_pass = Stopwatch();
  frame.pass_pixels = frame.pass_film.done.size();
  frame.pixels_done = static_cast<std::uint64_t>(std::ranges::count(frame.pass_film.done, std::uint8_t{1}));
  frame.queue.refill(frame.tiles(frame.pass_film));
}

void begin_pass(Frame& frame, std::optional<Pass> next) {
  frame.pass = next ? std::move(*next) : Pass();
  frame.pass_film = Film();
  if (!next) return frame.queue.no_more();
  frame.pass_film = film_of_pass(frame.film, frame.pass);
  frame.pixels_kept = ~std::uint64_t{0};
  continue_pass(frame);
}

void begin_coarse(Frame& frame, int block) {
  frame.coarse.block = block;
  begin_pass(frame, block > 0 ? coarse_pass(frame.film.width, frame.film.height, block)
                              : next_pass(frame.film, frame.plan));
}

void plan_next_pass(Frame& frame) {
  while (frame.queue.waits_for_more()) begin_pass(frame, following_pass(frame));
}

Film film_so_far(const Frame& frame) { return joined(frame, frame.film, frame.pass_film); }

Film take_film(Frame& frame) { return joined(frame, std::move(frame.film), std::move(frame.pass_film)); }

}  // namespace sundog
