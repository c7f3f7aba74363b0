// A worker's part in a frame, on its own thread: opening it, reopening it after failures, and leaving.
#include "render/frame/frame_worker.h"

#include <algorithm>

#include "base/error.h"
#include "device/cl_status.h"

namespace sundog {
namespace {

using Phase = Frame::Phase;

// A tile of at most this many pixels is not made smaller when resources do not suffice.
constexpr std::uint64_t least_pixels = 1024;

void set_phase(Frame& frame, std::size_t i, Phase phase) {
  const std::lock_guard lock(frame.mutex);
  frame.workers[i].phase = phase;
  frame.changed.notify_all();
}

/// Calls visit(index in the tile, index in the film) for each pixel of a tile.
template <class Visit>
void for_each_pixel(const Film& film, const Tile& tile, const Visit& visit) {
  std::size_t at = 0;
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width);
    for (int x = tile.x; x < tile.x + tile.width; ++x) visit(at++, row + static_cast<std::size_t>(x));
  }
}

/// Records a failure. Returns false if the worker has failed too often.
bool note_failure(Frame& frame, std::size_t i, const char* what) {
  const std::lock_guard lock(frame.mutex);
  DeviceReport& report = frame.workers[i].report;
  report.messages.push_back(what);
  return ++report.failures < frame.workers[i].device->failures_allowed();
}

/// Opens the worker; counts failed OpenCL calls like later failures. Throws at once if a retry cannot help:
/// kernels that do not build, a process that is gone.
RenderTimes open(Frame& frame, std::size_t i) {
  while (true) {
    try {
      return frame.workers[i].device->open();
    } catch (const DeviceError& error) {
      if (error.status == 0 || frame.stop || !note_failure(frame, i, error.what())) throw;
    }
  }
}

/// A device expected to be of little use beside a fast one on the same cores gets only idle cores.
void be_nice(const Frame& frame, std::size_t i) {
  const auto estimate = [&](std::size_t k) { return frame.workers[k].device->info().estimate; };
  const int processor = frame.workers[i].device->processor();
  for (std::size_t k = 0; k < frame.workers.size(); ++k)
    if (processor >= 0 && frame.workers[k].device->processor() == processor &&
        estimate(k) > burden_factor * estimate(i))
      return frame.workers[i].device->be_nice();
}

void begin_work(Frame& frame, std::size_t i, const RenderTimes& times) {
  const std::lock_guard lock(frame.mutex);
  frame.workers[i].report.kernels_cached = times.cached;
  frame.workers[i].report.ready = true;
  if (!frame.timed) {
    frame.times = times;
    frame.timed = i;
  }
  frame.workers[i].phase = Phase::working;
}

}  // namespace

std::optional<TileRequest> request_of(Frame& frame, const Tile& tile) {
  TileRequest request;
  request.tile = tile;
  const std::lock_guard lock(frame.mutex);
  if (frame.over) return std::nullopt;
  const Pass& pass = frame.pass;
  const Film& film = frame.film;
  request.first_sample = pass.first_sample, request.sample_count = pass.sample_count;
  request.surfaces = pass.surfaces, request.costs = pass.costs;
  const std::size_t pixels = pixel_count(tile);
  if (!pass.pixels.empty()) {
    request.pixels.resize(pixels);
    for_each_pixel(frame.pass_film, tile,
                   [&](std::size_t at, std::size_t i) { request.pixels[at] = pass.pixels[i]; });
  }
  if (pass.first_sample == 0) return request;
  request.sums.resize(pixels);
  request.weights.resize(pixels);
  request.rays.resize(film.rays.empty() ? 0 : pixels);
  const std::size_t vectors = pass.surfaces ? film.layout.vectors() : 0;
  request.aovs.resize(vectors * pixels);
  for_each_pixel(frame.pass_film, tile, [&](std::size_t at, std::size_t i) {
    prefetch_sums(film, pass, i + pixels_ahead);
    const std::int64_t found = image_index(film, pass, i);
    if (found < 0) return;
    const auto p = static_cast<std::size_t>(found);
    request.sums[at] = film.sums[p];
    request.weights[at] = film.weights[p];
    if (!request.rays.empty()) request.rays[at] = film.rays[p];
    std::copy_n(film.aovs.begin() + static_cast<std::ptrdiff_t>(vectors * p), vectors,
                request.aovs.begin() + static_cast<std::ptrdiff_t>(vectors * at));
  });
  return request;
}

TileResult render_in_picture(const Frame& frame, DeviceWorker& worker, TileRequest request,
                             const StopFlags& flags) {
  if (!frame.options.region) return worker.render(request, flags);
  const Tile asked = request.tile;
  if (request.pixels.empty()) request.tile.x += frame.area.x, request.tile.y += frame.area.y;
  const u32 corner = static_cast<u32>(frame.area.x) | static_cast<u32>(frame.area.y) << 16;
  for (u32& pixel : request.pixels)
    if (pixel != NO_PIXEL) pixel += corner;
  TileResult made = worker.render(request, flags);
  made.tile.x = asked.x, made.tile.y = asked.y;
  return made;
}

void take_figures(Frame& frame, std::size_t i) {
  WorkerFigures figures = frame.workers[i].device->figures();
  const std::lock_guard lock(frame.mutex);
  DeviceReport& report = frame.workers[i].report;
  frame.readback = std::max(frame.readback, figures.readback_seconds);
  static_cast<WorkerFigures&>(report) = std::move(figures);
}

bool recover(Frame& frame, std::size_t i, const TileJob& job, const DeviceError& error) {
  const bool too_large = is_out_of_resources(error.status) && pixel_count(job.tile) > least_pixels;
  if (too_large) frame.queue.halve(i, job.tile);
  frame.queue.failed(i, job);
  if (frame.stop) return false;
  if (!too_large && !note_failure(frame, i, error.what())) throw;
  open(frame, i);  // a failed driver may have lost more than the launch
  return true;
}

void retire_worker(Frame& frame, std::size_t i, const std::string& why, std::exception_ptr error) {
  frame.queue.retire(i);
  const std::lock_guard lock(frame.mutex);
  Frame::Worker& worker = frame.workers[i];
  if (worker.failed) return;
  worker.failed = worker.report.retired = true;
  if (worker.report.messages.empty() || worker.report.messages.back() != why)
    worker.report.messages.push_back(why);
  frame.last_error = std::move(error);
  if (std::ranges::all_of(frame.workers, &Frame::Worker::failed)) frame.queue.close();
}

void work_on_frame(Frame& frame, std::size_t i) {
  try {
    be_nice(frame, i);
    if (frame.queue.wait_until_needed(i)) {
      const RenderTimes times = open(frame, i);
      begin_work(frame, i, times);
      frame.queue.ready(i);
      make_tiles(frame, i);
    }
  } catch (const std::exception& error) {
    retire_worker(frame, i, error.what(), std::current_exception());
  }
  take_figures(frame, i);
}

void leave_frame(Frame& frame, std::size_t i, bool closes) {
  set_phase(frame, i, Phase::closing);
  try {
    DeviceWorker& worker = *frame.workers[i].device;
    closes ? worker.close() : worker.keep_programs();
  } catch (const std::exception&) {
    // The device is gone either way; the frame keeps its finished tiles.
  }
  set_phase(frame, i, Phase::gone);
}

}  // namespace sundog
