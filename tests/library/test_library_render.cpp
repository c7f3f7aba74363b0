// Renders through the public interface: the command line's bits, callbacks, cancellation, errors.
#include <atomic>
#include <chrono>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>
#include <thread>

#include "file_bytes.h"
#include "library_testing.h"
#include "run_command.h"
#include "temporary_folder.h"

using sundog::ErrorKind;

namespace {

std::vector<std::string> command_line(const std::string& scene, const std::string& out) {
  std::vector<std::string> arguments{"render", scene, "-o", out, "--size", "64x48", "--quiet"};
  if (!test_spec().empty()) arguments.insert(arguments.end(), {"--device", test_spec()});
  return arguments;
}

/// Takes long enough to be stopped: many samples of a scene of glass.
sundog::Scene long_scene() {
  sundog::Scene scene = sundog::Scene::load(shipped_scene("spheres"));
  return scene.set_size(1024, 768).set_samples(4096);
}

sundog::Scene tiny_formula(double size) {
  sundog::Scene scene;
  scene.set_size(16, 12).add_light({.type = "ambient"});
  return scene.add_formula({.distance = "length(p) - size", .parameters = {{"size", size}}}, {});
}

/// A scene whose kernel nobody has compiled yet: a constant of its formula is new.
sundog::Scene new_scene() {
  std::random_device random;
  const double size = 1 + 1e-9 * (random() % 1'000'000);
  return tiny_formula(size);
}

/// The process's address space, in bytes.
double addresses() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages;
  return pages * 4096;
}

}  // namespace

TEST_CASE("a render has the command line's bytes in every kind of file") {
  const TemporaryFolder folder;
  sundog::Scene scene = sundog::Scene::load(shipped_scene("spheres"));
  scene.set_size(64, 48);
  const sundog::Film film = sundog::render(scene, {.devices = test_device(), .aovs = {"depth", "normal"}});
  CHECK(film.complete());
  CHECK(film.width() == 64);
  CHECK(film.image().channels() == 4);
  CHECK(film.aov("depth").channels() == 1);
  CHECK(film.aov("normal").channels() == 3);
  CHECK(film.aovs() == std::vector<std::string>{"depth", "normal"});
  CHECK(film.figures().primary == 64u * 48 * 4);
  CHECK(film.figures().devices.at(0).share == 1);
  for (const std::string extension : {"png", "exr", "pfm"}) {
    CAPTURE(extension);
    const std::string ours = (folder / ("ours." + extension)).string(),
                      theirs = (folder / ("theirs." + extension)).string();
    std::vector<std::string> arguments = command_line(shipped_scene("spheres").string(), theirs);
    if (extension == "exr") arguments.insert(arguments.end(), {"--aov", "depth", "--aov", "normal"});
    const CommandResult command = run_sundog(arguments);
    CAPTURE(command.err);
    REQUIRE(command.status == 0);
    film.save(ours);
    CHECK(file_bytes(ours) == file_bytes(theirs));
  }
}

TEST_CASE("a mesh made in code is seen where it stands, and a formula beside it") {
  const std::vector<std::array<float, 3>> corners{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  sundog::Scene scene;
  scene.set_size(32, 16).set_camera({.position = {0, 0, 8}, .target = {0, 0, 0}, .fov = 30});
  scene.add_light({.type = "ambient"});
  scene.add_material("green", {.color = {0, 1, 0}, .ambient = 1, .diffuse = 0});
  scene.add_material("blue", {.color = {0, 0, 1}, .ambient = 1, .diffuse = 0});
  scene.add_mesh("square", {.positions = corners, .triangles = triangles});
  sundog::Mat4 left = sundog::identity, right = sundog::identity;
  left[3] = -2, right[3] = 2;
  scene.add_instance("square", {.material = "green", .name = "square", .transform = left});
  scene.add_formula({.map = {}, .distance = "length(p) - size", .parameters = {{"size", 1.0}}},
                    {.material = "blue", .name = "ball", .transform = right});
  const sundog::Film film = sundog::render(scene, {.devices = test_device()});
  const auto pixel = [image = film.image()](int x, int y) {
    return image.pixels().subspan(std::size_t(4 * (32 * y + x)), 4);
  };
  CHECK(pixel(8, 8)[1] == Approx(1).margin(1e-6));
  CHECK(pixel(24, 8)[2] == Approx(1).margin(1e-6));
  CHECK(pixel(24, 8)[1] == Approx(0).margin(1e-6));
  CHECK(pixel(16, 8)[3] == 0);
}

TEST_CASE("progress and pictures come while a frame is made, and end with it") {
  std::atomic<std::uint64_t> calls{0}, last{0}, total{0}, pictures{0};
  sundog::Scene scene = small_scene();
  scene.set_size(320, 240).set_samples(256);
  sundog::RenderOptions options{.devices = test_device()};
  options.on_progress = [&](const sundog::Progress& now) {
    ++calls;
    last = now.pixels_done;
    total = now.pixels_total;
  };
  options.picture_seconds = 0.01;
  options.on_picture = [&](const sundog::Image& image) { pictures += image.width() == 320; };
  const sundog::Film film = sundog::render(scene, options);
  CHECK(film.complete());
  CHECK(calls > 0);
  CHECK(last == 320u * 240);
  CHECK(total == 320u * 240);
  CHECK(pictures > 0);
}

TEST_CASE("progress is reported before the first tile is made, and a callback can end the render there") {
  sundog::Scene scene = long_scene();
  scene.set_samples(65536);
  sundog::RenderOptions options{.devices = test_device(), .tile = 1024};
  int calls = 0;
  options.on_progress = [&](const sundog::Progress& now) {
    CHECK(now.pixels_done == 0);
    CHECK(now.pixels_total == 1024u * 768);
    if (++calls == 3) throw std::out_of_range("the program's own");
  };
  CHECK_THROWS_AS(sundog::render(scene, options), std::out_of_range);
  CHECK(calls == 3);
}

TEST_CASE("a render that is stopped from another thread returns what it has") {
  std::stop_source source;
  std::atomic<bool> begun{false};
  sundog::RenderOptions options{.devices = test_device(), .stop = source.get_token()};
  options.on_progress = [&](const sundog::Progress&) { begun = true; };
  std::jthread stopper([&] {
    while (!begun) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    source.request_stop();
  });
  const sundog::Film film = sundog::render(long_scene(), options);
  CHECK_FALSE(film.complete());
  CHECK(film.width() == 1024);
}

TEST_CASE("a render that is stopped before it begins has no pixel") {
  std::stop_source source;
  source.request_stop();
  const sundog::Film film =
      sundog::render(small_scene(), {.devices = test_device(), .stop = source.get_token()});
  CHECK_FALSE(film.complete());
  CHECK(std::ranges::count(film.image().pixels(), 0.0f) == 64 * 48 * 4);
}

TEST_CASE("what a callback throws ends the render and comes out of it") {
  sundog::RenderOptions options{.devices = test_device()};
  options.on_progress = [](const sundog::Progress&) { throw std::out_of_range("the program's own"); };
  CHECK_THROWS_AS(sundog::render(long_scene(), options), std::out_of_range);
}

TEST_CASE("renders that are stopped keep no addresses") {
  std::stop_source source;
  source.request_stop();
  const sundog::Scene scene = small_scene();
  const auto stop_some = [&] {
    for (int i = 0; i < 40; ++i) (void)sundog::render(scene, {.stop = source.get_token()});
  };
  stop_some();
  const double before = addresses();
  stop_some();
  CHECK(addresses() - before < 1e9);  // a thread's stack alone has 256 MiB
}

TEST_CASE("a stop and a time limit do not wait for a compiler, though nobody keeps scene and devices") {
  std::stop_source source;
  source.request_stop();
  const auto seconds_of = [](const sundog::RenderOptions& options) {
    const auto begun = std::chrono::steady_clock::now();
    const bool complete = sundog::render(new_scene(), options).complete();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begun;
    return std::pair(complete, time.count());
  };
  const auto [whole, compiled] = seconds_of({});
  CHECK(whole);
  for (const sundog::RenderOptions& options :
       {sundog::RenderOptions{.time_limit = 0.01}, sundog::RenderOptions{.stop = source.get_token()}}) {
    const auto [complete, seconds] = seconds_of(options);
    CAPTURE(compiled, seconds);
    CHECK_FALSE(complete);
    CHECK(seconds < std::max(0.5, 0.5 * compiled));
  }
}

TEST_CASE("a time limit ends a render") {
  CHECK_FALSE(sundog::render(long_scene(), {.devices = test_device(), .time_limit = 0.2}).complete());
}

TEST_CASE("a picture is the same for every work-group and tile") {
  const sundog::Scene scene = small_scene();
  const sundog::Image wanted = sundog::render(scene, {.devices = test_device()}).image();
  for (const unsigned size : {1u, 16u}) {
    const sundog::Film film =
        sundog::render(scene, {.devices = test_device(), .work_group = {.x = size}, .tile = 16});
    CHECK(same_pixels(film.image(), wanted));
  }
  CHECK(same_pixels(sundog::render(scene, {.devices = test_device(), .work_group = {.driver = true}}).image(),
                    wanted));
}

TEST_CASE("errors of a render have their kind") {
  const sundog::Scene scene = small_scene();
  const auto kind_of = [&](const sundog::RenderOptions& options) {
    return error_of([&] { (void)sundog::render(scene, options); }).kind();
  };
  CHECK(kind_of({.devices = test_device(), .aovs = {"colour"}}) == ErrorKind::usage);
  CHECK(kind_of({.devices = test_device(), .work_group = {.x = 8, .y = 0}}) == ErrorKind::usage);
  CHECK(kind_of({.devices = test_device(), .tile = -1}) == ErrorKind::usage);
  for (const double seconds : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK(kind_of({.devices = test_device(), .time_limit = seconds}) == ErrorKind::usage);
    CHECK(kind_of({.devices = test_device(), .picture_seconds = seconds}) == ErrorKind::usage);
  }
  CHECK(kind_of({.devices = {sundog::Device{}}}) == ErrorKind::usage);
  sundog::Device broken = test_device().at(0);
  broken.usable = false;
  broken.problem = "it is unplugged";
  CHECK(kind_of({.devices = {broken}}) == ErrorKind::device);
  CHECK(error_of([] { (void)sundog::render(sundog::Scene::from_json("{}")); }).kind() == ErrorKind::scene);
  const sundog::Film film = sundog::render(scene, {.devices = test_device()});
  CHECK(error_of([&] { (void)film.aov("depth"); }).kind() == ErrorKind::usage);
  const TemporaryFolder folder;
  CHECK(error_of([&] { film.save(folder / "a.gif"); }).kind() == ErrorKind::usage);
  CHECK(error_of([&] { film.save(folder / "none" / "a.png"); }).kind() == ErrorKind::io);
  CHECK(error_of([&] { sundog::Film().save(folder / "a.png"); }).kind() == ErrorKind::usage);
}

TEST_CASE("a kernel that does not build is an error with the compiler's log") {
  const char* text =
      R"({"image": {"width": 8, "height": 8}, "camera": {"position": [0, 0, 5], "target": [0, 0, 0]},
    "materials": {"white": {}}, "objects": [{"type": "native", "material": "white", "code": "return no_such_function(p);",
      "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}}]})";
  const sundog::Scene scene = sundog::Scene::from_json(text, ".", {.native_code = true});
  const sundog::Error error = error_of([&] { (void)sundog::render(scene, {.devices = test_device()}); });
  CHECK(error.kind() == ErrorKind::build);
  CAPTURE(error.what());
  CHECK(error.log().find("no_such_function") != std::string::npos);
  sundog::Session session(test_device());
  session.start(scene);
  CHECK(error_of([&] { (void)session.finish(); }).kind() == ErrorKind::build);
  CHECK(session.snapshot().state == sundog::SessionState::failed);
}

TEST_CASE("a frame that takes more memory than there is is refused before anything is drawn") {
  std::ifstream meminfo("/proc/meminfo");
  double available = 0;  // KiB
  for (std::string word; available == 0 && meminfo >> word;)
    if (word == "MemAvailable:") meminfo >> available;
  if (available > 32.0 * 1024 * 1024) {
    WARN("there is room for the largest frame here: a want of memory is not tried");
    return;
  }
  sundog::Scene scene = small_scene();
  scene.set_size(16384, 16384).set("/render/progressive", "true");
  const sundog::Error error = error_of([&] {
    (void)sundog::render(scene, {.devices = test_device(), .aovs = {"normal", "position", "albedo"}});
  });
  CHECK(error.kind() == ErrorKind::internal);
  CHECK(std::string(error.what()).find("16384x16384 pixels takes") != std::string::npos);
  sundog::Session session(test_device());
  CHECK(error_of([&] { session.start(scene); }).kind() == ErrorKind::internal);
}

TEST_CASE("devices are chosen as the command line chooses them") {
  CHECK(error_of([] { (void)sundog::choose_devices({"no such device"}); }).kind() == ErrorKind::device);
  CHECK(error_of([] { (void)sundog::choose_devices({""}); }).kind() == ErrorKind::usage);
  const auto all = sundog::devices();
  CHECK(std::ranges::any_of(all, &sundog::Device::usable));
  std::vector<std::string> warnings;
  CHECK(error_of([] { (void)sundog::choose_devices({"all", "!no such device"}); }).kind() ==
        ErrorKind::device);
  CHECK_FALSE(sundog::choose_devices({"all", "!no such device?"}, &warnings).empty());
  CHECK(warnings.empty());
}

TEST_CASE("renders of several threads at once have the bits of one after the other") {
  const sundog::Scene scene = small_scene();
  const auto device = test_device();
  const sundog::Image wanted = sundog::render(scene, {.devices = device}).image();
  std::array<sundog::Image, 3> images;
  {
    std::vector<std::jthread> threads;
    for (sundog::Image& image : images)
      threads.emplace_back([&] { image = sundog::render(scene, {.devices = device}).image(); });
  }
  for (const sundog::Image& image : images) CHECK(same_pixels(image, wanted));
}

TEST_CASE("no thread stays in a driver that works") {
  const auto devices = test_device();
  (void)sundog::render(small_scene(), {.devices = devices});
  CHECK(sundog::threads_left_behind() == 0);
}
