// Frames in passes on devices: the same bits for every tile, work-group and split, after an interruption, and
// as a plain frame where all pixels have all samples; pictures near the full ones.
#include <atomic>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "catch.h"
#include "devices.h"
#include "render/film/sampling_report.h"
#include "same_bits.h"
#include "scenes.h"
#include "temporary_folder.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// A white ball and a thin bar above a floor with checkers, lit by a point.
SceneDescription ball_scene(int samples) {
  SceneDescription scene = scenes::line_of_sight({0.3, 1.6, 5}, {0, 0.1, 0});
  scene.camera.fov = 40;
  scene.image.width = 45;
  scene.image.height = 38;
  scene.render.samples = samples;
  scene.image.background_top = {0.2, 0.4, 0.9};
  LightDescription point;
  point.position = {-4, 6, 5};
  scene.lights.push_back(point);
  const int floor = scenes::add_white(scene);
  scene.materials[static_cast<std::size_t>(floor)].checker = true;
  const int white = scenes::add_white(scene);
  scenes::place(scene, PlaneShape{}, floor, glm::translate(glm::dmat4(1), dvec3(0, -1, 0)));
  scenes::place(scene, SphereShape{0.8}, white, glm::translate(glm::dmat4(1), dvec3(-0.5, -0.2, 0)));
  scenes::place(scene, BoxShape{{0.02, 1.5, 0.02}}, scenes::add_mirror(scene, 0.5, {0.5, 0.1, 0.1}),
                glm::rotate(glm::translate(glm::dmat4(1), dvec3(0.9, 0, 0.4)), 0.3, dvec3(0, 0, 1)));
  return scene;
}

SceneDescription adaptive_scene() {
  SceneDescription scene = ball_scene(16);
  scene.render.sampling.threshold = 0.05;
  return scene;
}

SceneDescription subsampled_scene() {
  SceneDescription scene = ball_scene(2);
  scene.render.sampling.subsample = true;
  return scene;
}

double root_mean_square(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) sum += std::pow(a.data[i] - b.data[i], 2);
  return std::sqrt(sum / static_cast<double>(a.data.size()));
}

}  // namespace

TEST_CASE("adaptive and subsampled frames have the same bits for every tile and work-group") {
  for (const SceneDescription& scene : {adaptive_scene(), subsampled_scene()})
    on_picture_devices([&](const DeviceInfo& info) {
      const RenderResult whole = scenes::render_on(info, scene);
      CHECK(whole.complete);
      RenderOptions options;
      options.tile = 8;
      options.work_group = {WorkGroup::Kind::fixed, 2, 1};
      const RenderResult tiled = scenes::render_on(info, scene, options);
      CHECK(same_bits(whole.image, tiled.image));
      CHECK(whole.film.taken == tiled.film.taken);
      CHECK(whole.counts == tiled.counts);
    });
}

TEST_CASE("a frame in passes has a plain frame's bits where every pixel has every sample") {
  SceneDescription plain = ball_scene(6), passes = plain;
  plain.render.sampler = SAMPLER_SOBOL;
  passes.render.sampling.progressive = true;
  on_picture_devices([&](const DeviceInfo& info) {
    const RenderResult expected = scenes::render_on(info, plain), made = scenes::render_on(info, passes);
    CHECK(same_bits(expected.image, made.image));
    CHECK(expected.counts == made.counts);
    CHECK(made.film.stage == 4);  // 1, 2, 4, 6
  });
}

TEST_CASE("an adaptive frame continues after an interruption to the same bits") {
  const SceneDescription scene = adaptive_scene();
  const DeviceInfo& info = test_devices().front();
  const RenderResult whole = scenes::render_on(info, scene);
  const TemporaryFolder folder;
  RenderOptions options;
  options.tile = 12;
  options.resume = folder / "checkpoint";
  int interrupted = 0;
  for (int tiles = 1; tiles < 200; tiles += 6) {
    std::atomic<bool> stop{false};
    int seen = 0;
    options.stop = &stop;
    options.on_progress = [&](const RenderProgress&) { stop = stop || ++seen >= tiles; };
    const RenderResult part = scenes::render_on(info, scene, options);
    if (!part.complete) {
      ++interrupted;
      continue;
    }
    CHECK(same_bits(whole.image, part.image));
    CHECK(whole.film.taken == part.film.taken);
    CHECK(interrupted > 1);
    return;
  }
  FAIL("it never came to its end");
}

TEST_CASE("adaptive and subsampled pictures are near the full ones with fewer samples") {
  SceneDescription full = ball_scene(16), reference = ball_scene(256), few = ball_scene(4);
  full.render.sampler = reference.render.sampler = few.render.sampler = SAMPLER_SOBOL;
  const DeviceInfo& info = test_devices().front();
  const Image right = scenes::render_on(info, reference).image;
  const RenderResult adaptive = scenes::render_on(info, adaptive_scene());
  const SamplingFigures figures =
      sampling_figures(adaptive.film.taken, adaptive.film.done, adaptive.film.surfaces_seen, 16);
  CHECK(figures.saved > 0.2);
  CHECK(figures.most == 16);
  CHECK(root_mean_square(adaptive.image, right) <
        0.8 * root_mean_square(scenes::render_on(info, few).image, right));

  const RenderResult sparse = scenes::render_on(info, subsampled_scene());
  const Image all = scenes::render_on(info, ball_scene(2)).image;
  CHECK(root_mean_square(sparse.image, all) < 0.01);
  CHECK(sampling_figures(sparse.film.taken, sparse.film.done, 0, 2).share_interpolated > 0.05);
}

TEST_CASE("adaptive pictures of paths and of a lens are as bright as even ones") {
  const auto light_of = [](const SceneDescription& scene) {
    const Film film = scenes::render_on(test_devices().front(), scene).film;
    double light = 0;
    for (std::size_t p = 0; p < film.pixels(); ++p) {
      const Color color = mean_of(film.sums[p], film.weights[p]);
      light += color.r + color.g + color.b;
    }
    return light;
  };
  for (const char* name : {"cornell_path", "lens"}) {
    SceneDescription even = scenes::shipped_small(name);
    even.image.width = 90, even.image.height = 60;
    even.render.samples = 64;
    even.render.sampler = SAMPLER_SOBOL;
    SceneDescription adaptive = even;
    adaptive.render.sampling.threshold = 0.05;
    INFO(name);
    CHECK(light_of(adaptive) == Approx(light_of(even)).epsilon(0.005));
  }
}

TEST_CASE("a frame that its time limit ends is saved, and continues from its checkpoint") {
  SceneDescription scene = ball_scene(32768);
  scene.render.sampling.progressive = true;
  const TemporaryFolder folder;
  RenderOptions options;
  options.time_limit = 0.3;
  options.checkpoint = folder / "checkpoint";
  const RenderResult result = scenes::render_on(test_devices().front(), scene, options);
  CHECK_FALSE(result.complete);
  CHECK(result.time_limited);
  CHECK(result.checkpoint_kept);
  // Its whole passes are shown, which ended in the middle of another: all pixels have the samples of one.
  REQUIRE(result.film.taken.front() > 0);
  CHECK(std::ranges::count(result.film.taken, result.film.taken.front()) == std::ssize(result.film.taken));
  scene.render.samples = static_cast<int>(result.film.taken.front());
  CHECK(same_bits(result.image, scenes::render_on(test_devices().front(), scene).image));
}

TEST_CASE("a part of a frame in passes is refused") {
  RenderOptions options;
  options.part = {1, 2};
  CHECK_THROWS_AS(scenes::render_on(test_devices().front(), adaptive_scene(), options), UsageError);
}
