// A frame's threads without a device: workers that are made up take tiles, fail, hang and are stopped.
#include "render/frame/frame_loop.h"

#include <chrono>
#include <thread>

#include "base/driver_threads.h"
#include "base/error.h"
#include "catch.h"
#include "render/film/checkpoint.h"
#include "render/render.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

constexpr int width = 64, height = 48;

float value_of(int x, int y) { return static_cast<float>(y * width + x); }

/// Makes tiles whose pixels are value_of() and whose primary rays are their pixels.
struct MadeUpWorker : DeviceWorker {
  std::function<void(int tile)> before = [](int) {};  // throws what the driver would; tiles count from 1
  std::atomic<bool> hangs{false};
  int tiles = 0;
  DeviceInfo device;

  MadeUpWorker() { device.estimate = 1; }
  const DeviceInfo& info() const override { return device; }
  RenderTimes open() override { return {}; }
  WorkerFigures figures() const override { return {}; }
  void close() override {}
  double overdue() const override { return hangs ? 1 : 0; }
  int processor() const override { return -1; }

  TileResult render(const TileRequest& request, const StopFlags& flags) override {
    const Tile& tile = request.tile;
    before(++tiles);
    TileResult made;
    made.tile = tile;
    if (flags.set()) made.tile.height = 0;
    for (int y = 0; y < made.tile.height; ++y)
      for (int x = 0; x < tile.width; ++x) {
        made.sums.push_back({value_of(tile.x + x, tile.y + y), 0, 0, 1});
        made.weights.push_back(static_cast<float>(request.sample_count));
      }
    made.counts[COUNT_PRIMARY] = made.sums.size();
    return made;
  }
};

using Workers = std::vector<std::shared_ptr<MadeUpWorker>>;

Workers workers(int count) {
  Workers all;
  for (int i = 0; i < count; ++i) all.push_back(std::make_shared<MadeUpWorker>());
  return all;
}

/// A frame in tiles of 8x8 pixels, all for anybody.
std::shared_ptr<Frame> frame_of(const Workers& workers, RenderOptions options = {}) {
  DeviceSpeed speed;
  speed.estimate = 1;
  auto frame = std::make_shared<Frame>(std::move(options), SamplingPlan{}, Film(width, height, FilmNeeds{}),
                                       std::vector(workers.size(), speed));
  for (const auto& worker : workers) frame->workers.push_back({worker, {}});
  frame->tiles = [](const Film&) {
    TilePlan plan;
    plan.whole = true;
    plan.lists.emplace_back(cut_tiles(width, height, 8));
    return plan;
  };
  begin_pass(*frame, next_pass(frame->film, frame->plan));
  return frame;
}

/// That the film is whole and every pixel was counted once.
void check_whole(Frame& frame) {
  const std::lock_guard lock(frame.mutex);
  CHECK(frame.queue.complete());
  CHECK(frame.counts[COUNT_PRIMARY] == width * height);
  CHECK(frame.pixels_done == width * height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      REQUIRE(frame.film.sums[static_cast<std::size_t>(y * width + x)].x == value_of(x, y));
}

}  // namespace

TEST_CASE("every pixel of a frame is counted once, whichever worker makes it") {
  const Workers all = workers(4);
  all[3]->before = [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); };
  const auto frame = frame_of(all);
  run_frame(frame, true);
  check_whole(*frame);
}

TEST_CASE("tiles that a worker failed at are made by it again or by others") {
  const Workers all = workers(3);
  int failures = 0;
  all[0]->before = [&](int tile) {
    if (tile % 4 == 1 && ++failures < 3) throw DeviceError("a launch failed", -14);
  };
  all[1]->before = [](int) { throw DeviceError("every launch fails", -14); };
  all[2]->before = [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  const auto frame = frame_of(all);
  run_frame(frame, true);
  check_whole(*frame);
  CHECK_FALSE(frame->workers[0].failed);
  CHECK_FALSE(frame->workers[2].failed);
  if (all[1]->tiles >= 3) CHECK(frame->workers[1].report.retired);
  CHECK(frame->workers[1].report.pixels == 0);
}

TEST_CASE("a frame whose workers all fail ends and keeps the failure") {
  const Workers all = workers(2);
  for (const auto& worker : all) worker->before = [](int) { throw DeviceError("every launch fails", -14); };
  const auto frame = frame_of(all);
  run_frame(frame, true);
  CHECK_FALSE(frame->queue.complete());
  REQUIRE(frame->last_error);
  CHECK_THROWS_AS(std::rethrow_exception(frame->last_error), DeviceError);
}

TEST_CASE("a worker that hangs is retired, and the frame ends without it") {
  const Workers all = workers(2);
  auto threads = std::make_shared<DriverThreads>();
  all[0]->device.threads = threads;
  std::atomic<bool> released{false};
  all[0]->before = [&](int) {
    all[0]->hangs = true;
    while (!released) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  const auto frame = frame_of(all);
  const auto is_retired = [&] {
    const std::lock_guard lock(frame->mutex);
    return frame->workers[0].failed;
  };
  all[1]->before = [&](int) {
    while (!is_retired()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  run_frame(frame, false);
  check_whole(*frame);
  {
    const std::lock_guard lock(frame->mutex);
    CHECK(frame->workers[0].report.abandoned);
    CHECK(frame->workers[0].report.retired);
    CHECK(frame->workers[0].report.pixels == 0);
    CHECK(frame->workers[1].report.pixels == width * height);
  }
  CHECK(threads->count() == 1);
  released = true;
  threads.reset();  // waits for it
}

TEST_CASE("a frame that is stopped keeps what was made, and its checkpoints hold no half tile") {
  const TemporaryFolder folder;
  const Workers all = workers(3);
  std::atomic<bool> stop{false};
  RenderOptions options;
  options.stop = &stop;
  options.checkpoint = folder / "frame.checkpoint";
  options.checkpoint_seconds = 0;
  options.on_progress = [&](const RenderProgress& progress) {
    if (progress.pixels_done >= progress.pixels_total / 2) stop = true;
  };
  for (const auto& worker : all)
    worker->before = [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
  const auto frame = frame_of(all, options);
  run_frame(frame, true);
  CHECK(frame->pixels_done >= width * height / 2);
  CHECK(frame->counts[COUNT_PRIMARY] == frame->pixels_done);
  CHECK(std::ranges::count(film_so_far(*frame).done, 1) == static_cast<std::ptrdiff_t>(frame->pixels_done));
  if (std::filesystem::exists(options.checkpoint)) {
    Film film(width, height, FilmNeeds{}), kept;
    Pass pass;
    read_checkpoint(options.checkpoint, film, pass, kept, frame->key);
    CHECK(std::ranges::count(kept.done, 1) % 64 == 0);
  }
}
