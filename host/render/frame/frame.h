// A frame from its plan to its image: threads, one a worker, take tiles from the queue, while another watches
// for the end, for an interrupt and for drivers that hang. Internal to the render layer.
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

/// Coarse passes before a frame's own, where somebody waits for it.
struct CoarsePasses {
  CoarsePicture picture;     // what is complete
  int block = 0;             // the pass in hand is of such blocks; 0: it is one of the frame's own
  unsigned count = 0;        // that are complete
  double pixel_seconds = 0;  // a sample's of a pixel, by the last pass over coarse or all pixels or the frame
                             // before; 0: not known
};

/// State that the frame's threads share. It lives until the last thread has left, perhaps after the frame's
/// end.
struct Frame : std::enable_shared_from_this<Frame> {
  /// `film` is empty: begin_pass() or continue_pass() come next.
  Frame(RenderOptions options_, SamplingPlan plan_, Film film_, const std::vector<DeviceSpeed>& speeds);

  enum class Phase { opening, working, closing, gone };
  struct Worker {
    std::shared_ptr<DeviceWorker> device;
    DeviceReport report = {};
    Phase phase = Phase::opening;
    bool failed = false;  // for good
  };

  const RenderOptions options;
  const SamplingPlan plan;
  std::function<TilePlan(const Film&)> tiles;  // of a pass, whose finished tiles are given
  Tile area, inner;  // of the picture, that the film holds; of the film, that are the region
  std::vector<Worker> workers;
  std::mutex mutex;  // for everything below, and the workers' reports and phases
  std::condition_variable changed;
  Film film;       // of the passes that are complete
  Pass pass;       // the one in hand; none where the film is complete
  Film pass_film;  // the finished tiles of that pass
  CoarsePasses coarse;
  TileQueue queue;
  RayCounts counts{};
  RenderTimes times;                 // of the first worker to be ready
  std::optional<std::size_t> timed;  // that worker
  double readback = 0;
  std::exception_ptr last_error;
  // Pixels of the pass: all, those that are done, those in the checkpoint.
  std::uint64_t pass_pixels = 0, pixels_done = 0, pixels_kept = 0;
  std::uint64_t key = 0;        // the checkpoint's
  std::string checkpoint_left;  // RenderResult::checkpoint_left
  Stopwatch clock, since_checkpoint, since_picture, since_pass;
  Stopwatch since_progress;                        // was reported; guarded by the mutex
  std::function<void(std::size_t)> between_tiles;  // called by each worker's thread, with its index
  bool live = false;                               // the workers' figures are kept up to date
  bool over = false;                               // the result is being gathered: nothing more goes in
  bool limited = false;                            // the time limit ended it
  std::atomic<bool> stop{false};
};

/// Where a frame that does not come to its end is kept; empty: nowhere.
inline const std::filesystem::path& checkpoint_path(const RenderOptions& options) {
  return options.checkpoint.empty() ? options.resume : options.checkpoint;
}

// frame.cpp

/// Plans the frame and begins its first pass, or continues its checkpoint. Throws what render() does
/// (render.h).
std::shared_ptr<Frame> begin_frame(const CompiledScene& scene, const std::vector<WorkerPlan>& devices,
                                   const RenderOptions& options);

/// Gathers what was made of a frame that is over. Throws the failure of the last device when the frame is
/// lost.
RenderResult finish_frame(Frame& frame);

/// Plans the next pass when all tiles of the one in hand are done; without another the frame is complete.
/// The caller holds the frame's mutex, or is alone with it, here and below.
void plan_next_pass(Frame& frame);

/// Begins a pass; without one the frame is complete.
void begin_pass(Frame& frame, std::optional<Pass> next);

/// Begins the rest of a pass of which Frame::pass_film has a part.
void continue_pass(Frame& frame);

/// Makes tiles by worker i until there are none, the frame is stopped, or the worker has failed too often
/// (which throws).
void make_tiles(Frame& frame, std::size_t i);

/// The film of the complete passes, with the finished tiles of the pass in hand.
Film film_so_far(const Frame& frame);

/// Moves film_so_far() out of a frame that is over.
Film take_film(Frame& frame);

/// Whether there is a pixel of the frame.
inline bool has_pixels(const Frame& frame) { return frame.pixels_done > 0 || frame.film.stage > 0; }

// frame_coarse.cpp

/// Puts the passes of a frame that somebody waits for behind coarse ones, from `block` on (0: none).
void begin_coarse(Frame& frame, int block);

/// Ends a coarse pass, whose picture may now be looked at. Returns the next one, or nothing when the frame's
/// own follow.
std::optional<Pass> finer_pass(Frame& frame);

/// Notes how long a pixel of the frame's first pass took.
void measure_pixels(Frame& frame);

// frame_worker.cpp

/// Takes part with worker i until the frame is over: opens it, makes tiles, notes what it did. A worker that
/// fails too often is retired. What it throws is kept in the frame.
void work_on_frame(Frame& frame, std::size_t i);

/// Takes a worker out of the frame: what it holds goes to others; without any other, the frame ends.
void retire_worker(Frame& frame, std::size_t i, const std::string& why, std::exception_ptr error);

/// Called by a worker's thread after work_on_frame(), for a frame that watch_frame() watches. Closes the
/// worker if `closes`; otherwise writes its compiled kernels to the cache.
void leave_frame(Frame& frame, std::size_t i, bool closes);

// frame_end.cpp

/// Passes on the caller's wish to stop (options.stop); before the first tile is taken, none is.
void stop_if_asked(Frame& frame);

/// Ends the frame at its time limit. The caller holds its mutex.
void stop_at_time_limit(Frame& frame);

/// Reports how far the frame is. The caller holds its mutex.
void report_progress(Frame& frame);

/// Retires workers whose launches are overdue.
void retire_hanging(Frame& frame);

}  // namespace sundog
