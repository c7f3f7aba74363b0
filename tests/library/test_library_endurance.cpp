// Many renders in one process, and how soon one stops: figures are printed.
#include <malloc.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include "library_testing.h"

namespace {

/// The memory, threads and files that the process holds.
struct Held {
  double megabytes = 0;
  long threads = 0, files = 0;
};

Held held() {
  Held now;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") status >> now.megabytes;
    if (word == "Threads:") status >> now.threads;
  }
  now.megabytes /= 1024;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) now.files += entry.exists();
  return now;
}

void render_often(int count) {
  mallopt(M_ARENA_MAX, 1);  // or what it holds depends on which threads met
  sundog::Scene scene = sundog::Scene::load(shipped_scene("spheres")).set_size(32, 24);
  const auto device = test_device();
  Held early;
  for (int i = 1; i <= count; ++i) {
    scene.set("/camera/fov", 30 + 0.01 * i);
    REQUIRE(sundog::render(scene, {.devices = device}).complete());
    if (i == count / 4) early = held();
  }
  const Held late = held();
  std::printf("%d renders: %.1f MB after %d, %.1f MB at the end; threads %ld, %ld; open files %ld, %ld\n",
              count, early.megabytes, count / 4, late.megabytes, early.threads, late.threads, early.files,
              late.files);
  CHECK(late.threads <= early.threads);
  CHECK(late.files <= early.files);
  CHECK(late.megabytes < early.megabytes + 8);
}

}  // namespace

TEST_CASE("renders leave nothing behind") { render_often(60); }

TEST_CASE("a thousand renders leave nothing behind", "[.endurance]") { render_often(1000); }

TEST_CASE("how soon a render stops when another thread asks", "[.endurance]") {
  sundog::Scene scene = sundog::Scene::load(shipped_scene("spheres")).set_size(1024, 768).set_samples(4096);
  for (int i = 0; i < 5; ++i) {
    std::stop_source source;
    std::atomic<bool> begun{false};
    std::chrono::steady_clock::time_point asked;
    sundog::RenderOptions options{.devices = test_device(), .stop = source.get_token()};
    options.on_progress = [&](const sundog::Progress&) { begun = true; };
    std::jthread stopper([&] {
      while (!begun) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      asked = std::chrono::steady_clock::now();
      source.request_stop();
    });
    CHECK_FALSE(sundog::render(scene, options).complete());
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - asked;
    std::printf("stopped %.0f ms after it was asked to\n", taken.count());
  }
}
