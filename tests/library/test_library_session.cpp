// Sessions of the public interface.
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <mutex>
#include <thread>

#include "file_bytes.h"
#include "library_testing.h"
#include "run_command.h"
#include "temporary_folder.h"

using sundog::ErrorKind;
using sundog::SessionState;

TEST_CASE("two sessions in one process at once have the command line's bits") {
  const TemporaryFolder folder;
  const std::vector<std::string> names{"spheres", "mandelbulb"};
  std::vector<sundog::Image> images;
  {
    sundog::Session first(test_device()), second(test_device());
    std::vector<sundog::Scene> scenes;
    for (const std::string& name : names)
      scenes.push_back(sundog::Scene::load(shipped_scene(name)).set_size(48, 32));
    first.start(scenes[0]);
    second.start(scenes[1]);
    images = {first.finish(), second.finish()};
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string ours = (folder / "ours.pfm").string(), theirs = (folder / "theirs.pfm").string();
    std::vector<std::string> arguments{"render", shipped_scene(names[i]).string(), "-o", theirs, "--size",
                                       "48x32"};
    if (!test_spec().empty()) arguments.insert(arguments.end(), {"--device", test_spec()});
    REQUIRE(run_sundog(arguments).status == 0);
    images[i].save(ours);
    CAPTURE(names[i]);
    CHECK(file_bytes(ours) == file_bytes(theirs));
  }
}

TEST_CASE("two sessions at once on different devices have the command line's bits") {
  const std::string spec = test_spec().empty() ? "all" : test_spec();
  std::vector<sundog::Device> devices;
  try {
    devices = sundog::choose_devices({spec + "/1", spec + "/1"});
  } catch (
      const sundog::Error&) {  // one unit, or a driver that splits none: the next device, if there is one
    for (const sundog::Device& device : sundog::devices())
      if (device.usable && devices.size() < 2) devices.push_back(device);
  }
  if (devices.size() < 2) {
    WARN("there is but one device here, and it cannot be split: two at once are not tried");
    return;
  }
  const TemporaryFolder folder;
  sundog::Scene scene = sundog::Scene::load(shipped_scene("spheres")).set_size(48, 32);
  std::vector<sundog::Session> sessions;
  for (std::size_t i = 0; i < 2; ++i) sessions.emplace_back(std::vector{devices[i]});
  for (const int intensity : {2, 1})  // an edit while both draw
    for (sundog::Session& session : sessions) session.start(scene.set("/lights/0/intensity", intensity));
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string ours = (folder / "ours.pfm").string(), theirs = (folder / "theirs.pfm").string();
    sessions[i].finish().save(ours);
    REQUIRE(run_sundog({"render", shipped_scene("spheres").string(), "-o", theirs, "--size", "48x32", "--set",
                        "/lights/0/intensity=1", "--device",
                        devices[i].label.substr(0, devices[i].label.find_first_of(" @"))})
                .status == 0);
    CAPTURE(devices[i].label);
    CHECK(file_bytes(ours) == file_bytes(theirs));
  }
}

TEST_CASE("an edit in a session draws the scene that it makes") {
  sundog::Scene scene = small_scene();
  sundog::Session session(test_device());
  const auto first = session.start(scene);
  const sundog::Image before = session.finish();
  scene.set("/lights/1/intensity", 0.25);
  const auto second = session.start(scene);
  CHECK(second == first + 1);
  const sundog::Image after = session.finish();
  CHECK_FALSE(same_pixels(before, after));
  CHECK(same_pixels(after, sundog::render(scene, {.devices = test_device()}).image()));
  const sundog::Snapshot now = session.snapshot(false);
  CHECK(now.state == SessionState::settled);
  CHECK(now.shown == second);
  CHECK(now.fraction == 1);
  CHECK(now.picture.pixels().empty());
}

TEST_CASE("a session is cancelled from another thread, and can be started again") {
  sundog::Scene scene = small_scene();
  scene.set_size(640, 480).set_samples(65536);
  sundog::Session session(test_device());
  CHECK(session.snapshot().state == SessionState::idle);
  session.start(scene);
  std::jthread([&] {
    while (session.snapshot(false).shown == 0) session.wait_for_change(session.snapshot(false).revision, 1);
    session.cancel();
  }).join();
  CHECK(session.wait_for(30));
  CHECK(session.snapshot().state == SessionState::stopped);
  CHECK(session.snapshot().picture.width() == 640);
  session.start(small_scene());
  CHECK(session.finish().width() == 64);
}

TEST_CASE(
    "a storm of edits, cancels and questions from many threads ends with the picture of the last scene") {
  sundog::Session session(test_device());
  session.start(small_scene());
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 3; ++thread)
      threads.emplace_back([&session, thread] {
        sundog::Scene scene = small_scene();
        for (int i = 0; i < 12; ++i) {
          session.start(scene.set("/camera/fov", 20 + 5 * thread + i), {.patience = 0.01 * thread});
          if (i % 3 == 1) session.cancel();
          if (i % 4 == 2) session.wait_for(0.02);
        }
      });
    threads.emplace_back([&session] {
      for (int i = 0; i < 40; ++i) {
        const sundog::Snapshot now = session.snapshot(i % 2 == 0);
        session.wait_for_change(now.revision, 0.01);
        if (i % 10 == 5) (void)session.pick(i, i);
      }
    });
    threads.emplace_back([&session] {
      for (int i = 0; i < 4; ++i) {
        session.use_devices(test_device());
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    });
  }
  sundog::Scene last = small_scene();
  last.set("/camera/fov", 33);
  session.start(last);
  CHECK(same_pixels(session.finish(), sundog::render(last, {.devices = test_device()}).image()));
}

TEST_CASE(
    "the owner of a mesh that a session lets go of may ask the session, or take a lock of the program's") {
  const std::vector<std::array<float, 3>> corners{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
  std::atomic<int> gone = 0, stuck = 0;
  {
    sundog::Session session(test_device());
    std::vector<std::future<void>> asked;
    std::mutex asking;
    const auto ask = [&](void*) {
      const std::lock_guard lock(asking);
      asked.push_back(std::async(std::launch::async, [&session] { (void)session.snapshot(); }));
      if (asked.back().wait_for(std::chrono::seconds(10)) != std::future_status::ready) ++stuck;
      ++gone;
    };
    sundog::Scene scene = small_scene();
    scene.add_instance("triangle", {.material = "red"});
    for (int frame = 0; frame < 6 && stuck == 0; ++frame) {
      scene.add_mesh(
          "triangle",
          {.positions = corners, .triangles = triangles, .owner = std::shared_ptr<void>(&session, ask)});
      session.start(scene, {.patience = frame < 3 ? 0.15 : 0});
      if (frame < 3) session.wait();
    }
    session.wait();
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (gone < 3 && std::chrono::steady_clock::now() < limit)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    CHECK(gone >= 3);
    CHECK(stuck == 0);
    scene = small_scene();
    session.start(scene);
    session.wait();
    while (gone < 6 && std::chrono::steady_clock::now() < limit)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  CHECK(gone == 6);
}

TEST_CASE("a session names what a pixel shows") {
  sundog::Session session(test_device());
  CHECK_FALSE(session.pick(1, 1).has_value());
  session.start(small_scene());
  session.wait();
  const auto ball = session.pick(32, 20);
  REQUIRE(ball.has_value());
  CHECK(ball->object == "ball");
  CHECK(ball->material == "red");
  CHECK(ball->depth == Approx(4).margin(0.2));
  CHECK(session.pick(32, 47)->object == "ground");
  const auto sky = session.pick(32, 0);
  REQUIRE(sky.has_value());
  CHECK(sky->object.empty());
  CHECK(std::isinf(sky->depth));
  CHECK_FALSE(session.pick(64, 0).has_value());
}

TEST_CASE("errors of a session have their kind, and leave it as it was") {
  sundog::Device broken = test_device().at(0);
  broken.usable = false;
  CHECK(error_of([&] { sundog::Session session({broken}); }).kind() == ErrorKind::device);
  sundog::Session session(test_device());
  session.start(small_scene());
  CHECK(error_of([&] { session.use_devices({sundog::Device{}}); }).kind() == ErrorKind::usage);
  CHECK(error_of([&] { session.start(sundog::Scene::from_json("{}")); }).kind() == ErrorKind::scene);
  CHECK(error_of([&] { session.start(small_scene(), {.work_group = {.x = 4, .y = 0}}); }).kind() ==
        ErrorKind::usage);
  CHECK(error_of([&] { session.start(small_scene(), {.tile = -1}); }).kind() == ErrorKind::usage);
  CHECK(error_of([&] { session.start(small_scene(), {.patience = -1}); }).kind() == ErrorKind::usage);
  CHECK(session.finish().width() == 64);
  sundog::Session moved = std::move(session);
  CHECK(moved.snapshot().generation == 1);
}
