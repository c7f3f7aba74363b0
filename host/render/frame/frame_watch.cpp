// Polls every 20 ms until the frame is over, then waits briefly for launches and for devices that close, and
// abandons the remaining threads.
#include <algorithm>

#include "render/frame/frame.h"

namespace sundog {
namespace {

using Phase = Frame::Phase;

// How long a launch may run on after the frame's end before its thread is abandoned; saving the compiled
// kernels for the next time may take longer, unless someone waits for the program to stop.
constexpr double launch_grace = 0.15, stop_grace = 0.5, closing_grace = 10;
constexpr double look_seconds = 0.02;

// Progress is reported with each tile, and at this interval while tiles take longer.
constexpr double progress_seconds = 0.1;

/// Shows the picture so far, every `picture_seconds`.
void show_picture(Frame& frame) {
  if (!frame.options.on_picture || frame.since_picture.seconds() < frame.options.picture_seconds) return;
  Film film;
  {
    const std::lock_guard lock(frame.mutex);
    if (!has_pixels(frame)) return;
    film = film_so_far(frame);
  }
  frame.options.on_picture(frame.options.region ? film.cut(frame.inner) : film);
  frame.since_picture = Stopwatch();
}

/// Reports progress even while no tile is finished, so that the callback can end the frame.
void show_progress(Frame& frame) {
  const std::lock_guard lock(frame.mutex);
  if (frame.since_progress.seconds() >= progress_seconds) report_progress(frame);
}

/// Waits until the frame is over; meanwhile does everything that is due and retires workers that hang.
void watch(Frame& frame) {
  while (!frame.queue.wait(look_seconds)) {
    show_progress(frame);
    stop_if_asked(frame);
    {
      const std::lock_guard lock(frame.mutex);
      stop_at_time_limit(frame);
    }
    renew_checkpoint(frame);
    show_picture(frame);
    retire_hanging(frame);
  }
}

/// Waits briefly for workers that may leave soon.
void wait_for_threads(Frame& frame, bool stopped) {
  const bool in_haste = stopped && frame.options.in_haste;
  std::unique_lock lock(frame.mutex);
  const auto wait = [&](double seconds, Phase phase) {
    frame.changed.wait_for(lock, std::chrono::duration<double>(seconds), [&] {
      return std::ranges::none_of(frame.workers, [&](const Frame::Worker& worker) {
        return !worker.failed && worker.phase == phase &&
               !(phase == Phase::working && worker.device->compiles());
      });
    });
  };
  wait(stopped && !in_haste ? stop_grace : launch_grace, Phase::working);
  if (!in_haste) wait(stopped ? stop_grace : closing_grace, Phase::closing);
}

}  // namespace

void watch_frame(Frame& frame, bool wait) {
  watch(frame);
  const bool stopped = frame.stop.exchange(true);
  if (!wait) wait_for_threads(frame, stopped);
  std::unique_lock lock(frame.mutex);
  const auto is_gone = [](const Frame::Worker& worker) { return worker.phase == Phase::gone; };
  if (wait) frame.changed.wait(lock, [&] { return std::ranges::all_of(frame.workers, is_gone); });
  for (Frame::Worker& worker : frame.workers) worker.report.abandoned = !is_gone(worker);
  frame.over = true;
}

}  // namespace sundog
