// Reports a frame's progress, ends it early if asked, and gathers its result.
#include "render/frame/frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace sundog {
namespace {

/// Whether the frame may end at its time limit. A frame in passes first completes a pass that can be shown,
/// and gets further than its checkpoint; otherwise it would never progress if compiling its kernels takes
/// longer than the limit. The caller holds its mutex.
bool may_end(const Frame& frame) {
  if (!in_passes(frame.plan.settings)) return true;
  return frame.film.stage > 0 && std::ranges::any_of(frame.workers, [](const Frame::Worker& worker) {
           return worker.report.pixels > 0;
         });
}

double frame_efficiency(const Frame& frame) {
  std::vector<DeviceWork> work;
  for (std::size_t i = 0; i < frame.workers.size(); ++i) work.push_back(frame.queue.work(i));
  return efficiency(work);
}

/// Crops film, image and AOVs to an area.
void cut_to(const Tile& area, RenderResult& result) {
  const auto cut = [&](Image& image) {
    image.data = cut_pixels(image.data, image.width, area, static_cast<std::size_t>(image.channels));
    image.width = area.width, image.height = area.height;
  };
  result.film = result.film.cut(area);
  cut(result.image);
  for (auto& [name, image] : result.aovs) cut(image);
}

/// Records whether the frame is complete, and if not, why.
void note_end(const Frame& frame, RenderResult& result) {
  const bool stopped = frame.options.stop && frame.options.stop->load();
  result.key = frame.key;
  result.complete = frame.queue.complete();
  result.time_limited = frame.limited && !result.complete;
  result.checkpoint_left = frame.checkpoint_left;
  if (!result.complete && !stopped) result.failure = frame.last_error;
}

/// Develops the film into image and AOVs; crops them all to the frame's region.
void make_images(const Frame& frame, RenderResult& result) {
  const RenderOptions& options = frame.options;
  if (options.channels > 0) {
    result.image = result.film.develop(options.channels);
    for (const std::string& name : options.aovs) result.aovs[name] = result.film.develop_aov(name);
  }
  if (options.region) cut_to(frame.inner, result);
}

/// Records times, ray counts, and each worker's share.
void note_figures(const Frame& frame, RenderResult& result) {
  result.devices = reports(frame);
  result.efficiency = frame_efficiency(frame);
  result.counts = frame.counts;
  result.times = frame.times;
  RenderTimes& times = result.times;
  if (frame.timed) times.build_kernels += first_launch_seconds(frame.workers[*frame.timed].report.kernels);
  times.readback = frame.readback;
  times.render = std::max(0.0, frame.clock.seconds() - times.build_kernels - times.upload - frame.readback);
}

}  // namespace

void report_progress(Frame& frame) {
  if (!frame.options.on_progress) return;
  frame.since_progress = Stopwatch();
  frame.options.on_progress({frame.pixels_done, frame.pass_pixels, frame.clock.seconds()});
}

void stop_at_time_limit(Frame& frame) {
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

void stop_if_asked(Frame& frame) {
  if (!frame.options.stop || !frame.options.stop->load()) return;
  frame.stop = true;
  frame.queue.close();
}

std::vector<DeviceReport> reports(const Frame& frame) {
  std::vector<DeviceReport> result;
  std::uint64_t pixels = 0;
  for (const Frame::Worker& worker : frame.workers) pixels += worker.report.pixels;
  for (std::size_t i = 0; i < frame.workers.size(); ++i) {
    DeviceReport report = frame.workers[i].report;
    report.busy_seconds = frame.queue.work(i).busy_seconds;
    report.share =
        static_cast<double>(report.pixels) / static_cast<double>(std::max<std::uint64_t>(1, pixels));
    result.push_back(std::move(report));
  }
  return result;
}

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
  make_images(frame, result);
  note_figures(frame, result);
  return result;
}

}  // namespace sundog
