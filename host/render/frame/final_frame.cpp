// Begins, continues and ends passes, and develops the film when the last is done.
#include "render/frame/final_frame.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "render/film/checkpoint.h"
#include "render/frame/frame_plan.h"

namespace sundog {
namespace {

/// Begins the first pass, or what a checkpoint leaves of one.
void begin_passes(Frame& frame) {
  const std::filesystem::path& file = frame.options.resume;
  if (!file.empty() && is_there(file)) {
    read_checkpoint(file, frame.film, frame.pass, frame.pass_film, frame.key);
    if (frame.pass.is_none() && frame.film.grows) return begin_pass(frame, std::nullopt);
    if (frame.pass.is_none()) {  // complete, perhaps of another part: keep its pixels, make those missing
      frame.pass_film = std::exchange(frame.film, Film(frame.film.width, frame.film.height, frame.film));
      frame.pass = *next_pass(frame.film, frame.plan);
    }
    if (!may_be_of(frame.plan, frame.pass)) throw damaged_checkpoint(file);
    continue_pass(frame);
  } else {
    begin_pass(frame, next_pass(frame.film, frame.plan));
  }
  frame.pixels_kept = frame.pixels_done;
  plan_next_pass(frame);
}

}  // namespace

std::shared_ptr<Frame> begin_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                                   const RenderOptions& options) {
  check_frame(scene, devices, options);
  std::string left;
  try {
    const std::shared_ptr<Frame> frame = plan_frame(scene, devices, options);
    begin_passes(*frame);
    return frame;
  } catch (const std::exception& error) {
    if (!options.renews_checkpoint || !is_there(options.resume)) throw;
    left = error.what();
  }
  RenderOptions anew = options;
  anew.checkpoint = checkpoint_path(options);
  anew.resume.clear();
  const std::shared_ptr<Frame> frame = plan_frame(scene, devices, anew);
  frame->checkpoint_left = std::move(left);
  begin_passes(*frame);
  return frame;
}

// Here run_frame() makes the passes (frame_loop.h).

namespace {

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

double frame_efficiency(const Frame& frame) {
  std::vector<DeviceWork> work;
  for (std::size_t i = 0; i < frame.workers.size(); ++i) work.push_back(frame.queue.work(i));
  return efficiency(work);
}

/// Keeps what an interrupted frame has; a disk that is full must not take the image along.
void keep_checkpoint(const Frame& frame, RenderResult& result) {
  if (checkpoint_path(frame.options).empty() || result.complete) return;
  try {
    write_checkpoint(checkpoint_path(frame.options), frame.film, frame.pass, frame.pass_film, frame.key,
                     frame.options.faults);
    result.checkpoint_kept = true;
  } catch (const IoError& error) {
    result.checkpoint_error = error.what();
  }
}

/// Makes image and AOVs of the film.
void develop(const RenderOptions& options, RenderResult& result) {
  if (options.channels == 0) return;
  result.image = result.film.develop(options.channels);
  for (const std::string& name : options.aovs) result.aovs[name] = result.film.develop_aov(name);
}

/// Leaves an area alone of what the frame has made.
void cut_to(const Tile& area, RenderResult& result) {
  const auto cut = [&](Image& image) {
    image.data = cut_pixels(image.data, image.width, area, static_cast<std::size_t>(image.channels));
    image.width = area.width, image.height = area.height;
  };
  result.film = result.film.cut(area);
  cut(result.image);
  for (auto& [name, image] : result.aovs) cut(image);
}

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

RenderResult finish_frame(Frame& frame) {
  const RenderOptions& options = frame.options;
  const bool stopped = options.stop && options.stop->load();
  const std::lock_guard lock(frame.mutex);
  RenderResult result;
  result.key = frame.key;
  result.complete = frame.queue.complete();
  result.time_limited = frame.limited && !result.complete;
  result.checkpoint_left = frame.checkpoint_left;
  if (!result.complete && !stopped) result.failure = frame.last_error;
  const bool is_lost = result.failure && !(options.keep_failed && has_pixels(frame));
  keep_checkpoint(frame, result);
  if (is_lost) std::rethrow_exception(result.failure);
  // With what there is of another pass, parts of the picture would have twice the samples of others.
  if (result.time_limited && frame.film.stage > 0) frame.pass_film = Film();
  result.film = take_film(frame);
  develop(options, result);
  if (options.region) cut_to(frame.inner, result);
  note_figures(frame, result);
  return result;
}

}  // namespace sundog
