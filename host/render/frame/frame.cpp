// A frame's story: plan, passes, film. Between begin_frame() and finish_frame() the threads of its workers
// render the passes (frame_loop.cpp), each tile by tile (frame_worker.cpp).
#include "render/frame/frame.h"

#include <algorithm>

#include "render/frame/frame_loop.h"
#include "render/plan/subsample.h"

namespace sundog {

RenderResult render_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& workers,
                          const RenderOptions& options, bool wait) {
  const std::shared_ptr<Frame> frame = begin_frame(scene, workers, options);
  run_frame(frame, wait);
  return finish_frame(*frame);
}

// The plan.

std::shared_ptr<Frame> begin_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                                   const RenderOptions& options) {
  check_frame(scene, devices, options);
  std::shared_ptr<Frame> frame = plan_frame(scene, devices, options);
  bool continues = false;
  try {
    continues = continue_checkpoint(*frame);
  } catch (const std::exception& error) {
    if (!options.renews_checkpoint) throw;
    frame.reset();  // its workers are created again
    frame = plan_frame(scene, devices, options);
    frame->checkpoint_left = error.what();
  }
  if (!continues) begin_pass(*frame, next_pass(frame->film, frame->plan));
  frame->pixels_kept = frame->pixels_done;
  plan_next_pass(*frame);
  return frame;
}

// The passes: each is cut into tiles that workers render; finished tiles enter the film, from which the next
// pass is planned.

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

void continue_pass(Frame& frame) {
  frame.since_pass = Stopwatch();
  frame.pass_pixels = frame.pass_film.done.size();
  frame.pixels_done = static_cast<std::uint64_t>(std::ranges::count(frame.pass_film.done, std::uint8_t{1}));
  frame.queue.refill(frame.tiles(frame.pass_film));
}

namespace {

/// Ends a coarse pass, whose picture may now be displayed. Returns the next coarse pass, or nothing when the
/// frame's own passes follow.
std::optional<Pass> finer_pass(Frame& frame) {
  CoarsePasses& coarse = frame.coarse;
  coarse.picture.take(frame.pass, frame.pass_film, frame.film.width, frame.film.height, coarse.block);
  ++coarse.count;
  const double blocks = static_cast<double>(coarse.picture.colors.size());
  coarse.pixel_seconds = expected_pixel_seconds(frame.since_pass.seconds() / blocks, coarse.pixel_seconds);
  coarse.block = next_block(coarse.block, coarse.pixel_seconds, frame.film.pixels());
  if (coarse.block == 0) return std::nullopt;
  return coarse_pass(frame.film.width, frame.film.height, coarse.block);
}

/// Records how long a pixel of the frame's first pass took.
void measure_pixels(Frame& frame) {
  if (frame.film.stage == 0)
    frame.coarse.pixel_seconds = frame.since_pass.seconds() / static_cast<double>(frame.film.pixels());
}

/// Adds the complete pass to the film. Returns the next pass, as the film requires it.
std::optional<Pass> following_pass(Frame& frame) {
  if (frame.coarse.block > 0) {
    if (std::optional<Pass> finer = finer_pass(frame)) return finer;
  } else {
    measure_pixels(frame);
    add_pass(frame.film, frame.pass, std::move(frame.pass_film), true);
  }
  return next_pass(frame.film, frame.plan, frame.pass);
}

/// Adds the finished pixels of the current pass to the film of the earlier passes.
Film joined(const Frame& frame, Film film, Film made) {
  if (!made.done.empty() && frame.coarse.block == 0) add_pass(film, frame.pass, std::move(made), false);
  if (film.sums.empty()) film.allocate();
  if (frame.plan.settings.subsample && !frame.pass.is_none()) interpolate_rest(film);
  return film;
}

}  // namespace

void plan_next_pass(Frame& frame) {
  while (frame.queue.waits_for_more()) begin_pass(frame, following_pass(frame));
}

// The film.

Film film_so_far(const Frame& frame) { return joined(frame, frame.film, frame.pass_film); }

Film take_film(Frame& frame) { return joined(frame, std::move(frame.film), std::move(frame.pass_film)); }

}  // namespace sundog
