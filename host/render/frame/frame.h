// A frame from its plan to its image: one thread per worker takes tiles from the queue, while another watches
// for the end, interrupts and hanging drivers. Outside the render layer only render_frame() is used.
#pragma once
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "compile/compiled_scene.h"
#include "render/frame/device_worker.h"
#include "render/frame/result.h"
#include "render/frame/tile_queue.h"
#include "render/plan/coarse.h"
#include "render/plan/passes.h"

namespace sundog {

/// Coarse passes before a frame's own passes, for an interactive viewer.
struct CoarsePasses {
  CoarsePicture picture;     // the last complete coarse picture
  int block = 0;             // block edge of the current pass; 0: it is one of the frame's own
  unsigned count = 0;        // complete coarse passes
  double pixel_seconds = 0;  // seconds per pixel and sample in the last pass or frame; 0: unknown
};

/// State that the frame's threads share. It lives until the last thread has left, which may be after the
/// frame's end.
struct Frame : std::enable_shared_from_this<Frame> {
  /// `film` is empty; begin_pass() or continue_pass() must follow.
  Frame(RenderOptions options_, SamplingPlan plan_, Film film_, const std::vector<DeviceSpeed>& speeds);

  enum class Phase { opening, working, closing, gone };
  struct Worker {
    std::shared_ptr<DeviceWorker> device;
    DeviceReport report = {};
    Phase phase = Phase::opening;
    bool failed = false;  // permanently
  };

  const RenderOptions options;
  const SamplingPlan plan;
  std::function<TilePlan(const Film&)> tiles;  // plans a pass's tiles, given its finished pixels
  Tile area, inner;                            // the film's part of the picture; the region within the film
  std::vector<Worker> workers;
  std::mutex mutex;  // guards everything below, and the workers' reports and phases
  std::condition_variable changed;
  Film film;       // complete passes
  Pass pass;       // the current one; none if the film is complete
  Film pass_film;  // finished tiles of the current pass
  CoarsePasses coarse;
  TileQueue queue;
  RayCounts counts{};
  RenderTimes times;                 // of the worker that was ready first
  std::optional<std::size_t> timed;  // that worker's index
  double readback = 0;
  std::exception_ptr last_error;
  // Pixels of the pass: all, finished, in the checkpoint.
  std::uint64_t pass_pixels = 0, pixels_done = 0, pixels_kept = 0;
  std::uint64_t key = 0;        // the checkpoint's
  std::string checkpoint_left;  // RenderResult::checkpoint_left
  Stopwatch clock, since_checkpoint, since_picture, since_pass;
  Stopwatch since_progress;                        // last report; guarded by the mutex
  std::function<void(std::size_t)> between_tiles;  // called by each worker's thread, with the worker's index
  bool live = false;                               // the workers' figures are kept up to date
  bool over = false;     // the result is being gathered; tiles are no longer accepted
  bool limited = false;  // ended by the time limit
  std::atomic<bool> stop{false};
};

/// The file in which an unfinished frame is saved; empty: none.
inline const std::filesystem::path& checkpoint_path(const RenderOptions& options) {
  return options.checkpoint.empty() ? options.resume : options.checkpoint;
}

// frame.cpp

/// Plans, runs and finishes a frame. Throws like render() (render.h). With `wait`, every thread has ended on
/// return; otherwise DeviceInfo::threads takes over the threads inside a driver.
RenderResult render_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& workers,
                          const RenderOptions& options, bool wait);

/// Plans the frame and begins its first pass, or continues from its checkpoint. Throws like render().
std::shared_ptr<Frame> begin_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                                   const RenderOptions& options);

/// Begins the frame with coarse passes before its own, starting with blocks of edge `block` (0: none).
void begin_coarse(Frame& frame, int block);

/// Plans the next pass if all tiles of the current one are done; without a next pass the frame is complete.
/// Here and below, the caller holds the frame's mutex or has the only thread.
void plan_next_pass(Frame& frame);

/// Begins a pass; with none, the frame is complete.
void begin_pass(Frame& frame, std::optional<Pass> next);

/// Begins the rest of the current pass, whose finished pixels are in Frame::pass_film.
void continue_pass(Frame& frame);

/// The film of the complete passes, plus the finished tiles of the current pass.
Film film_so_far(const Frame& frame);

/// Moves film_so_far() out of a frame that is over.
Film take_film(Frame& frame);

/// Whether any pixel of the frame is finished.
inline bool has_pixels(const Frame& frame) { return frame.pixels_done > 0 || frame.film.stage > 0; }

// frame_plan.cpp

/// Throws UsageError for options that no frame of the scene supports, DeviceError without devices.
void check_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                 const RenderOptions& options);

/// Creates a frame with its plan of passes and tiles and its workers. No pass has begun.
std::shared_ptr<Frame> plan_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                                  const RenderOptions& options);

// frame_checkpoint.cpp

/// Continues the frame from its checkpoint. Returns false if there is none. Throws for a damaged one or one
/// of another frame.
bool continue_checkpoint(Frame& frame);

/// Saves a checkpoint periodically, or when the caller asks, so that a killed process or a power failure
/// loses little.
void renew_checkpoint(Frame& frame);

/// Saves an interrupted frame. Records a full disk in `result` instead of throwing, so that the image can
/// still be written.
void keep_checkpoint(const Frame& frame, RenderResult& result);

// frame_watch.cpp

/// Waits on the caller's thread for the frame's end: finished, stopped (options.stop), or out of workers.
/// Meanwhile reports progress, shows the picture, saves checkpoints, retires workers that hang. With `wait`,
/// every worker has left it on return; otherwise, after a short grace period, workers inside a driver are
/// abandoned.
void watch_frame(Frame& frame, bool wait);

// frame_worker.cpp

/// Has worker i render until the frame is over: opens it, renders tiles, records its figures. Retires a
/// worker that fails too often, and stores its exception in the frame.
void work_on_frame(Frame& frame, std::size_t i);

/// Removes a worker from the frame: its tiles go to others; if it was the last, the frame ends.
void retire_worker(Frame& frame, std::size_t i, const std::string& why, std::exception_ptr error);

/// Called by a worker's thread after work_on_frame(), in a frame that watch_frame() watches. Closes the
/// worker if `closes`; otherwise writes its compiled kernels to the cache.
void leave_frame(Frame& frame, std::size_t i, bool closes);

// frame_end.cpp

/// Stops the frame if the caller wishes it (options.stop), even before its first tile.
void stop_if_asked(Frame& frame);

/// Ends the frame if its time limit has passed. The caller holds its mutex.
void stop_at_time_limit(Frame& frame);

/// Reports the frame's progress. The caller holds its mutex.
void report_progress(Frame& frame);

/// Retires workers whose launches are overdue.
void retire_hanging(Frame& frame);

/// The workers' reports, with their shares of the work. The caller holds the frame's mutex.
std::vector<DeviceReport> reports(const Frame& frame);

/// Gathers the result of a frame that is over. Rethrows the last device's failure if the frame is lost.
RenderResult finish_frame(Frame& frame);

}  // namespace sundog
