// A frame's steps: plan, passes, film, image. The threads of its workers (frame_loop.h: run_frame()) render
// the passes between begin_frame() and finish_frame().
#include "render/frame/frame.h"

#include <algorithm>

#include "render/frame/frame_checkpoint.h"
#include "render/frame/frame_end.h"
#include "render/frame/frame_plan.h"
#include "render/frame/frame_worker.h"
#include "render/plan/subsample.h"

namespace sundog {

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

void continue_pass(Frame& frame) {
  frame.since_pass = Stopwatch();
  frame.pass_pixels = frame.pass_film.done.size();
  frame.pixels_done = static_cast<std::uint64_t>(std::ranges::count(frame.pass_film.done, std::uint8_t{1}));
  frame.queue.refill(frame.tiles(frame.pass_film));
}

namespace {

/// Copies a tile, or its finished rows, into the film. The caller holds the frame's mutex.
void keep_tile(Frame& frame, std::size_t i, const TileResult& made) {
  if (frame.over || made.tile.height == 0) return;
  frame.pixels_done += frame.pass_film.put(made.tile, made);
  for (std::size_t c = 0; c < COUNTERS; ++c) frame.counts[c] += made.counts[c];
  frame.workers[i].report.pixels += pixel_count(made.tile);
  if (!frame.stop || !in_passes(frame.plan.settings)) plan_next_pass(frame);  // planning may take long
  report_progress(frame);
  stop_if_asked(frame);
  stop_at_time_limit(frame);
}

/// Renders one tile; throws the worker's exceptions.
void make_tile(Frame& frame, std::size_t i, const TileJob& job) {
  const StopFlags flags{&frame.stop, &frame.queue.cancelled(i)};
  const Stopwatch busy;
  std::optional<TileRequest> request = request_of(frame, job.tile);
  if (!request) return;
  const TileResult made = render_in_picture(frame, *frame.workers[i].device, std::move(*request), flags);
  const double seconds = busy.seconds();
  const bool whole = made.tile == job.tile;
  // Queue and film change under one lock: when the queue has no tiles left, the film has them all.
  const std::lock_guard lock(frame.mutex);
  const bool first = whole ? frame.queue.finished(i, job, seconds) : frame.queue.given_up(i, job);
  if (first) keep_tile(frame, i, made);
  (first ? frame.workers[i].report.tiles : frame.workers[i].report.outrun) += whole || !first;
}

}  // namespace

void make_tiles(Frame& frame, std::size_t i) {
  while (const std::optional<TileJob> job = frame.queue.take(i)) {
    if (frame.between_tiles) frame.between_tiles(i);
    try {
      make_tile(frame, i, *job);
      if (frame.live) take_figures(frame, i);
    } catch (const DeviceError& error) {
      if (!recover(frame, i, *job, error)) return;
    }
  }
}

namespace {

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

// The image.

RenderResult finish_frame(Frame& frame) {
  const std::lock_guard lock(frame.mutex);
  RenderResult result;
  note_end(frame, result);
  const bool is_lost = result.failure && !(frame.options.keep_failed && has_pixels(frame));
  keep_checkpoint(frame, result);
  if (is_lost) std::rethrow_exception(result.failure);
  // Drops the unfinished pass, with which parts of the picture would have twice the samples of others.
  if (result.time_limited && frame.film.stage > 0) frame.pass_film = Film();
  result.film = take_film(frame);
  develop(frame, result);
  note_figures(frame, result);
  return result;
}

}  // namespace sundog
