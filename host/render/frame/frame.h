// A frame at work: one thread a server takes tiles from the queue, while the caller's thread watches for the
// end, for an interrupt and for drivers that hang. Internal to the render layer.
#pragma once
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "render/frame/tile_server.h"
#include "render/plan/passes.h"
#include "render/plan/tile_queue.h"

namespace sundog {

/// A frame that is made in passes: the one in hand is Frame::film and the queue's tiles.
struct FramePasses {
  GrowingFilm film;  // all passes before
  Pass pass;
  SamplingPlan plan;
  std::function<TilePlan(const Film&)> tiles;  // of a pass
};

/// What the threads share. It lives until the last of them is gone, which may be after the frame's end.
struct Frame {
  Frame(RenderOptions options_, Film film_, TilePlan plan, std::vector<DeviceSpeed> speeds)
      : options(std::move(options_)), film(std::move(film_)), queue(std::move(plan), std::move(speeds)) {}

  enum class Phase { opening, working, closing, gone };
  struct Server {
    std::shared_ptr<TileServer> server;
    DeviceReport report;
    Phase phase = Phase::opening;
    bool failed = false;  // for good
  };

  const RenderOptions options;
  std::vector<Server> servers;
  std::mutex mutex;  // for everything below, and the servers' reports and phases
  std::condition_variable changed;
  Film film;
  std::optional<FramePasses> passes;
  TileQueue queue;
  RayCounts counts{};
  RenderTimes times;  // of the first server to be ready
  bool timed = false;
  double readback = 0;
  std::exception_ptr last_error;
  std::uint64_t pixels_done = 0, pixels_kept = 0;  // the latter are in the checkpoint
  std::uint64_t key = 0;                           // the checkpoint's
  Stopwatch clock, since_checkpoint, since_picture;
  bool over = false;     // the result is being gathered: nothing more goes in
  bool limited = false;  // the time limit ended it
  std::atomic<bool> stop{false};
};

/// Where a frame that does not come to its end is kept; empty: nowhere.
inline const std::filesystem::path& checkpoint_path(const RenderOptions& options) {
  return options.checkpoint.empty() ? options.resume : options.checkpoint;
}

/// Plans the next pass when all pixels of the one in hand are done; without another the frame is complete.
/// The caller holds the frame's mutex, or is alone with it.
void plan_next_pass(Frame& frame);

/// What there is of the picture: of a frame in passes with what is done of the one in hand.
GrowingFilm film_so_far(const Frame& frame);

/// Writes the frame's state.
void write_frame_checkpoint(const Frame& frame, const std::filesystem::path& path);

/// Runs the frame to its end: finished, stopped (options.stop), or out of servers. With `wait`, every thread
/// has ended on return; else those in a driver are left behind (see threads_left_behind()).
void run_frame(const std::shared_ptr<Frame>& frame, bool wait);

}  // namespace sundog
