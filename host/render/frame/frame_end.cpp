// How far a frame is, and what ends it early.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "render/frame/frame.h"

namespace sundog {
namespace {

/// Whether the frame may end at its time limit. In several passes it first makes a whole one to show, and
/// gets further than a checkpoint that it began with: else it would not if its kernels are compiled for
/// longer. The caller holds its mutex.
bool may_end(const Frame& frame) {
  if (!in_passes(frame.plan.settings)) return true;
  return frame.film.stage > 0 && std::ranges::any_of(frame.workers, [](const Frame::Worker& worker) {
           return worker.report.pixels > 0;
         });
}

}  // namespace

void report_progress(Frame& frame) {
  if (!frame.options.on_progress) return;
  frame.since_progress = Stopwatch();
  frame.options.on_progress({frame.pixels_done, frame.pass_pixels, frame.clock.seconds()});
}

void look_at_clock(Frame& frame) {
  if (!(frame.options.time_limit > 0) || frame.clock.seconds() < frame.options.time_limit) return;
  if (!may_end(frame)) return;
  frame.limited = true;
  frame.stop = true;
  frame.queue.close();
}

void retire_hanging(Frame& frame) {
  for (std::size_t i = 0; i < frame.workers.size(); ++i) {
    const double seconds = frame.workers[i].device->overdue();
    if (seconds <= 0) continue;
    const std::string why = fmt::format("{}: a launch has not come back for {:.0f} s: the driver hangs",
                                        frame.workers[i].device->info().label(), seconds);
    retire_worker(frame, i, why, std::make_exception_ptr(DeviceError(why)));
  }
}

void look_for_stop(Frame& frame) {
  if (!frame.options.stop || !frame.options.stop->load()) return;
  frame.stop = true;
  frame.queue.close();
}

}  // namespace sundog
