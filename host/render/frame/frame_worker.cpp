// A worker's part in a frame, on its own thread: opens it, renders tiles into the film, reopens it after
// failures, and leaves.
#include "render/frame/frame.h"

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

/// The request for a tile, with its pixels' earlier samples; nothing if the frame is over.
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

/// Has the worker render a tile of the frame, translated to the frame's place in the picture.
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

void take_figures(Frame& frame, std::size_t i) {
  WorkerFigures figures = frame.workers[i].device->figures();
  const std::lock_guard lock(frame.mutex);
  DeviceReport& report = frame.workers[i].report;
  frame.readback = std::max(frame.readback, figures.readback_seconds);
  static_cast<WorkerFigures&>(report) = std::move(figures);
}

/// Handles worker i's failure at a tile, in the handler that caught it: returns the tile to the queue and
/// reopens the worker. Returns false if the frame is stopped. Rethrows the failure if the worker has failed
/// too often.
bool recover(Frame& frame, std::size_t i, const TileJob& job, const DeviceError& error) {
  const bool too_large = is_out_of_resources(error.status) && pixel_count(job.tile) > least_pixels;
  if (too_large) frame.queue.halve(i, job.tile);
  frame.queue.failed(i, job);
  if (frame.stop) return false;
  if (!too_large && !note_failure(frame, i, error.what())) throw;
  open(frame, i);  // a failed driver may have lost more than the launch
  return true;
}

/// Renders tiles with worker i until none are left, the frame is stopped, or the worker has failed too often
/// (then throws its failure).
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

}  // namespace

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
