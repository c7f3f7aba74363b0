// A session's threads without a device: scenes that replace each other, are cancelled, fail and are picked
// from (ThreadSanitizer watches: preset tsan).
#include "render/session/render_session.h"

#include <atomic>
#include <future>
#include <random>
#include <thread>

#include "base/error.h"
#include "catch.h"
#include "render/frame/device_worker.h"
#include "render/plan/coarse.h"

using namespace sundog;

namespace {

constexpr int width = 40, height = 24;

/// A pixel's value: the intensity of the scene's first light plus the pixel's index; each sample the same.
float value_of(float light, int x, int y) { return light + static_cast<float>(y * width + x); }

/// A scene worker that makes value_of() and counts what it is asked for.
struct MadeUpWorker : SceneWorker {
  std::shared_ptr<const CompiledScene> scene;
  std::atomic<int> opened{0}, tiles{0}, pause_us{0};
  std::atomic<bool> fails{false}, does_not_build{false};
  std::atomic<bool> opens_never{false}, surfaces_build{false}, is_building{false}, hurried{false};
  bool open_ = false;
  DeviceInfo device;

  explicit MadeUpWorker(int index = 0) {
    device.estimate = 1;
    device.device = index;
  }
  const DeviceInfo& info() const override { return device; }
  void show(std::shared_ptr<const CompiledScene> next, const RenderOptions&) override {
    scene = std::move(next);
    open_ = false;
  }
  RenderTimes open() override {
    if (does_not_build) throw BuildError("the kernel does not build", "");
    if (opens_never) {
      is_building = true;
      while (!hurried) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      throw DeviceError("not wanted any more");
    }
    ++opened;
    open_ = true;
    return {};
  }
  bool is_open() const override { return open_; }
  void hurry() override { hurried = true; }
  void prepare_surfaces() override {
    is_building = true;
    while (surfaces_build) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  WorkerFigures figures() const override { return {}; }
  void close() override { open_ = false; }
  int processor() const override { return -1; }

  TileResult render(const TileRequest& request, const StopFlags& flags) override {
    ++tiles;
    if (fails) throw DeviceError("a made-up failure");
    if (pause_us > 0) std::this_thread::sleep_for(std::chrono::microseconds(pause_us));
    const Tile& tile = request.tile;
    TileResult made;
    made.tile = tile;
    if (flags.set()) made.tile.height = 0;
    const float light = scene->lights.empty() ? 0 : scene->lights[0].color.x;
    for (int y = 0; y < made.tile.height; ++y)
      for (int x = 0; x < tile.width; ++x) {
        const std::size_t i = made.sums.size();
        int at_x = tile.x + x, at_y = tile.y + y;
        if (!request.pixels.empty()) {
          const u32 pixel = request.pixels[i];
          at_x = static_cast<int>(pixel & 0xffffu), at_y = static_cast<int>(pixel >> 16);
        }
        const auto samples = static_cast<float>(request.sample_count);
        const float before = request.sums.empty() ? 0 : request.sums[i].x;
        const float weight = request.weights.empty() ? 0 : request.weights[i];
        made.sums.push_back({before + samples * value_of(light, at_x, at_y), 0, 0, 1});
        made.weights.push_back(weight + samples);
      }
    if (request.surfaces)
      made.aovs.assign(3 * std::size_t(tile.width) * std::size_t(tile.height),
                       {static_cast<float>(tile.x), static_cast<float>(tile.y), light, 1});
    made.counts[COUNT_PRIMARY] = made.sums.size();
    return made;
  }
};

using Made = std::vector<std::shared_ptr<MadeUpWorker>>;

Made workers(int count) {
  Made all;
  for (int i = 0; i < count; ++i) all.push_back(std::make_shared<MadeUpWorker>(i));
  return all;
}

std::vector<std::shared_ptr<SceneWorker>> given(const Made& made) { return {made.begin(), made.end()}; }

std::shared_ptr<const SceneDescription> scene_of(double light, int samples = 4) {
  auto scene = std::make_shared<SceneDescription>();
  scene->image.width = width;
  scene->image.height = height;
  scene->render.samples = samples;
  LightDescription lamp;
  lamp.intensity = light;
  scene->lights.push_back(lamp);
  scene->materials.emplace_back();
  Object ball;
  ball.material = 0;
  scene->objects.push_back(ball);
  return scene;
}

/// That a settled picture is of that scene.
void check_shows(const Snapshot& snapshot, double light) {
  REQUIRE(snapshot.state == SessionState::settled);
  CHECK(snapshot.shown == snapshot.generation);
  CHECK(snapshot.fraction == 1);
  CHECK(snapshot.block == 1);
  REQUIRE(snapshot.picture);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      REQUIRE(snapshot.picture->pixel(x, y)[0] == value_of(static_cast<float>(light), x, y));
}

}  // namespace

TEST_CASE("a session draws a scene until it is settled") {
  const Made made = workers(2);
  RenderSession session(given(made));
  CHECK(session.snapshot().state == SessionState::idle);
  CHECK_FALSE(session.snapshot().picture);
  session.wait();
  CHECK(session.start(scene_of(1000)) == 1);
  session.wait();
  const Snapshot snapshot = session.snapshot();
  check_shows(snapshot, 1000);
  CHECK(snapshot.samples == 4);
  CHECK(snapshot.times.first >= 0);
  CHECK(snapshot.times.first <= snapshot.times.full);
  CHECK(snapshot.times.full <= snapshot.times.settled);
  CHECK(snapshot.counts[COUNT_PRIMARY] >= width * height);
}

TEST_CASE("workers stay open from one scene to the next") {
  const Made made = workers(1);
  RenderSession session(given(made));
  for (int i = 1; i <= 5; ++i) {
    CHECK(session.start(scene_of(i)) == static_cast<Generation>(i));
    session.wait();
    check_shows(session.snapshot(), i);
  }
  CHECK(made[0]->opened == 5);
}

TEST_CASE("a storm of starts, cancels, picks and looks ends with the last scene") {
  const Made made = workers(3);
  made[1]->pause_us = 300;
  made[2]->pause_us = 2000;
  RenderSession session(given(made));
  std::atomic<bool> over{false};
  std::atomic<int> wrong_pictures{0}, wrong_picks{0};  // Catch takes assertions of one thread alone
  const auto look = [&] {
    std::uint64_t revision = 0;
    while (!over) {
      const Snapshot snapshot = session.snapshot();
      revision = snapshot.revision;
      if (snapshot.picture && snapshot.samples > 0)
        wrong_pictures += snapshot.picture->data.size() != std::size_t{4} * width * height;
      session.wait_for_change(revision, 0.01);
    }
  };
  const auto pick = [&] {
    std::mt19937 random(3);
    while (!over) {
      const auto x = static_cast<int>(random() % width), y = static_cast<int>(random() % height);
      if (const std::optional<Picked> picked = session.pick(x, y))
        wrong_picks += picked->normal.x != x || picked->normal.y != y ||
                       picked->normal.z != static_cast<float>(picked->scene->lights[0].intensity);
      std::this_thread::yield();
    }
  };
  std::vector<std::thread> threads;
  threads.emplace_back(look);
  threads.emplace_back(look);
  threads.emplace_back(pick);
  std::mt19937 random(5);
  for (int i = 1; i <= 300; ++i) {
    session.start(scene_of(i, 1 + int(random() % 8)));
    if (random() % 4 == 0) session.cancel();
    if (random() % 3 == 0) session.wait_for(0.002);
  }
  CHECK(session.start(scene_of(7777)) == 301);
  session.wait();
  check_shows(session.snapshot(), 7777);
  over = true;
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong_pictures == 0);
  CHECK(wrong_picks == 0);
}

TEST_CASE("scenes that follow each other fast are seen all the same") {
  const Made made = workers(1);
  made[0]->pause_us = 3000;
  RenderSession session(given(made));
  SessionSettings settings;
  settings.patience = 60;
  Generation last = 0;
  std::size_t seen = 0;
  for (int i = 1; i <= 400 && seen < 3; ++i) {
    session.start(scene_of(i, 64), settings);
    session.wait_for_change(session.snapshot(false).revision, 0.001);
    const Snapshot now = session.snapshot(false);
    seen += now.shown != last;
    last = now.shown;
  }
  CHECK(seen == 3);
  session.start(scene_of(2), settings);
  session.wait();
  check_shows(session.snapshot(), 2);
}

TEST_CASE("a cancelled scene stops, and keeps its picture") {
  const Made made = workers(1);
  RenderSession session(given(made));
  session.start(scene_of(5));
  session.wait();
  made[0]->pause_us = 20000;
  session.start(scene_of(6, 4096));
  session.cancel();
  session.wait();
  const Snapshot snapshot = session.snapshot();
  CHECK(snapshot.state == SessionState::stopped);
  CHECK(snapshot.generation == 2);
  REQUIRE(snapshot.picture);
}

TEST_CASE("errors of a scene and of a device are the session's state, and the next scene is drawn") {
  const Made made = workers(1);
  RenderSession session(given(made));
  SECTION("a scene that does not compile") {
    auto broken = std::make_shared<SceneDescription>(*scene_of(1));
    broken->objects[0].world_from_object = glm::dmat4(0);
    session.start(broken);
    session.wait();
    CHECK(session.snapshot().state == SessionState::failed);
    CHECK(session.snapshot().error.find("its transform") != std::string::npos);
  }
  SECTION("kernels that do not build") {
    made[0]->does_not_build = true;
    session.start(scene_of(1));
    session.wait();
    CHECK(session.snapshot().state == SessionState::failed);
    CHECK(session.snapshot().error == "the kernel does not build");
    CHECK_FALSE(session.pick(0, 0));
    made[0]->does_not_build = false;
  }
  SECTION("a device that fails") {
    made[0]->fails = true;
    session.start(scene_of(1));
    session.wait();
    CHECK(session.snapshot().state == SessionState::failed);
    CHECK(session.snapshot().error == "a made-up failure");
    made[0]->fails = false;
  }
  session.start(scene_of(2));
  session.wait();
  check_shows(session.snapshot(), 2);
}

TEST_CASE("a device that fails leaves its work to the others") {
  const Made made = workers(2);
  made[0]->fails = true;
  RenderSession session(given(made));
  session.start(scene_of(3));
  session.wait();
  check_shows(session.snapshot(), 3);
}

TEST_CASE("a pick is of the newest scene, and nothing outside the frame") {
  const Made made = workers(1);
  RenderSession session(given(made));
  CHECK_FALSE(session.pick(0, 0));
  session.start(scene_of(9, 64));
  const std::optional<Picked> picked = session.pick(7, 5);
  REQUIRE(picked);
  CHECK(picked->normal.x == 7);
  CHECK(picked->normal.y == 5);
  CHECK_FALSE(session.pick(width, 0));
  CHECK_FALSE(session.pick(0, -1));
}

/// What a pick in another thread gives within five seconds, after act(). The session ends with it.
template <class Act>
std::optional<Picked> pick_during(RenderSession& session, const Act& act) {
  auto asked = std::async(std::launch::async, [&] { return session.pick(7, 5); });
  act();
  const bool answered = asked.wait_for(std::chrono::seconds(5)) == std::future_status::ready;
  CHECK(answered);
  if (!answered) session.close();
  return asked.get();
}

TEST_CASE("a pick that nobody can answer ends") {
  const Made made = workers(1);
  RenderSession session(given(made));
  SECTION("because other devices are chosen, before it or meanwhile") {
    session.start(scene_of(9));
    session.wait();
    session.use_devices({DeviceInfo{}});
    CHECK_FALSE(pick_during(session, [] {}));
  }
  SECTION("because no device has opened the scene") {
    made[0]->opens_never = true;
    session.start(scene_of(9));
    while (!made[0]->is_building) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    session.cancel();
    CHECK_FALSE(pick_during(session, [] {}));
  }
}

TEST_CASE("cancel ends a pick that waits for its kernel, and the next one is answered") {
  const Made made = workers(1);
  RenderSession session(given(made));
  session.start(scene_of(9));
  session.wait();
  made[0]->surfaces_build = true;
  CHECK_FALSE(pick_during(session, [&] {
    while (!made[0]->is_building) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    session.cancel();
  }));
  CHECK(session.snapshot().state == SessionState::settled);
  made[0]->surfaces_build = false;
  CHECK(session.pick(7, 5));
}

TEST_CASE("a session ends in the middle of anything") {
  for (int i = 0; i < 30; ++i) {
    const Made made = workers(2);
    made[0]->pause_us = 1000;
    RenderSession session(given(made));
    session.start(scene_of(1, 1000));
    if (i % 3 == 1) session.wait_for_change(session.snapshot().revision, 0.001);
    if (i % 3 == 2) session.cancel();
  }
}

TEST_CASE("coarse pictures come while a frame would take longer") {
  constexpr std::size_t pixels = 640 * 640;
  CHECK(first_block(0, pixels) == 8);
  CHECK(first_block(0.01 / pixels, pixels) == 0);
  CHECK(first_block(1.0 / pixels, pixels) == 8);
  CHECK(first_block(100.0 / pixels, pixels) == 32);
  CHECK(next_block(32, 10.0 / pixels, pixels) == 16);
  CHECK(next_block(8, 0.2 / pixels, pixels) == 0);
  CHECK(next_block(8, 1.0 / pixels, pixels) == 0);
  CHECK(next_block(8, 1.5 / pixels, pixels) == 4);
  CHECK(next_block(4, 1.0 / pixels, pixels) == 0);
  CHECK(next_block(4, 9.0 / pixels, pixels) == 2);
  CHECK(next_block(2, 9.0 / pixels, pixels) == 0);
}

TEST_CASE("a coarse pass's time is that of the frame before, unless it has changed by much") {
  CHECK(expected_pixel_seconds(2, 0) == 2);
  CHECK(expected_pixel_seconds(2, 1) == 1);
  CHECK(expected_pixel_seconds(5, 1) == 5);
  CHECK(expected_pixel_seconds(0.5, 1) == 0.5);
}

TEST_CASE("a coarse pass has the middle of each block, at the edges too") {
  const Pass pass = coarse_pass(21, 10, 8);
  std::vector<u32> found;
  for (const u32 pixel : pass.pixels)
    if (pixel != NO_PIXEL) found.push_back(pixel);
  std::sort(found.begin(), found.end());
  CHECK(found == std::vector<u32>{4u | 4u << 16, 12u | 4u << 16, 20u | 4u << 16, 4u | 9u << 16,
                                  12u | 9u << 16, 20u | 9u << 16});
  Film made(pass.width, pass.height, false);
  for (std::size_t i = 0; i < made.sums.size(); ++i) {
    made.sums[i] = {2 * static_cast<float>(pass.pixels[i] & 0xffffu), 0, 0, 2};
    made.weights[i] = 2;
  }
  CoarsePicture picture;
  picture.take(pass, made, 21, 10, 8);
  CHECK(picture.at(0, 0).x == 4);
  CHECK(picture.at(15, 3).x == 12);
  CHECK(picture.at(20, 9).x == 20);
}
