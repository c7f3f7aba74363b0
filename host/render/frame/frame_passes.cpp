// The passes of a frame: coarse ones first where somebody waits, then its own, each planned from those
// before.
#include <algorithm>

#include "render/frame/frame.h"
#include "render/plan/subsample.h"

namespace sundog {
namespace {

std::size_t pixels_of(const Frame& frame) { return frame.passes->film.taken.size(); }

/// A coarse pass is complete: its picture may be looked at. Returns the block of the next one; 0: none.
int take_coarse(Frame& frame) {
  FramePasses& passes = *frame.passes;
  const Film& whole = passes.film.film;
  passes.coarse.take(passes.pass, frame.film, whole.width, whole.height, passes.coarse_block);
  ++passes.coarse_passes;
  const double blocks = static_cast<double>(passes.coarse.colors.size());
  passes.pixel_seconds = expected_pixel_seconds(passes.since_pass.seconds() / blocks, passes.pixel_seconds);
  return next_block(passes.coarse_block, passes.pixel_seconds, pixels_of(frame));
}

/// The pass that comes after the one that is complete.
std::optional<Pass> following_pass(Frame& frame) {
  FramePasses& passes = *frame.passes;
  if (passes.coarse_block == 0) {
    if (passes.film.stage == 0)
      passes.pixel_seconds = passes.since_pass.seconds() / static_cast<double>(pixels_of(frame));
    add_pass(passes.film, passes.pass, std::move(frame.film), true);
  } else {
    passes.coarse_block = take_coarse(frame);
    const Film& whole = passes.film.film;
    if (passes.coarse_block > 0) return coarse_pass(whole.width, whole.height, passes.coarse_block);
  }
  return next_pass(passes.film, passes.plan, passes.pass);
}

}  // namespace

void begin_coarse(Frame& frame, int block) {
  FramePasses& passes = *frame.passes;
  const Film& whole = passes.film.film;
  passes.coarse_block = block;
  passes.pass =
      block > 0 ? coarse_pass(whole.width, whole.height, block) : *next_pass(passes.film, passes.plan);
  frame.film = film_of_pass(passes.film, passes.pass, passes.pass.surfaces);
}

void plan_next_pass(Frame& frame) {
  const auto all_done = [&] { return std::ranges::count(frame.film.done, 0) == 0; };
  while (frame.passes && frame.queue.waits_for_more() && all_done()) {
    std::optional<Pass> next = following_pass(frame);
    frame.film = Film();
    frame.pixels_done = 0;
    frame.pixels_kept = ~std::uint64_t{0};
    if (!next) return frame.queue.no_more();
    FramePasses& passes = *frame.passes;
    passes.pass = std::move(*next);
    passes.since_pass = Stopwatch();
    frame.film = film_of_pass(passes.film, passes.pass, passes.pass.surfaces);
    frame.queue.refill(passes.tiles(frame.film));
  }
}

GrowingFilm film_so_far(const Frame& frame) {
  GrowingFilm film;
  if (!frame.passes) {
    film.film = frame.film;
    return film;
  }
  film = frame.passes->film;
  if (!frame.film.done.empty() && frame.passes->coarse_block == 0)
    add_pass(film, frame.passes->pass, frame.film, false);
  if (frame.passes->plan.settings.subsample) interpolate_rest(film);
  return film;
}

}  // namespace sundog
