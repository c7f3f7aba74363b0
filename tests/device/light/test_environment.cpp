// Light from all around: what rays see of it, how its directions are chosen, and what it does to surfaces;
// suns.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

#include "catch.h"
#include "compile/steps.h"
#include "device/choice.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi;
constexpr u32 count = 1u << 14;

/// A picture of one colour, with one pixel of another.
EnvironmentDescription picture(int width, int height, float all, int x = 0, int y = 0, float one = -1) {
  EnvironmentDescription e;
  e.type = EnvironmentType::image;
  e.picture = Image(width, height, 3);
  for (float& value : e.picture.data) value = all;
  if (one >= 0)
    for (int c = 0; c < 3; ++c) e.picture.pixel(x, y)[c] = one;
  return e;
}

// Four floats for each of `count` directions that are even over the sphere (density there, radiance) and each
// of as many samples (the density reported, that of the direction; radiance by density).
const char* const draw_kernel = R"(
#include "lib/core/sampler_lanes.cl"
#include "lib/path/environment_cells.cl"
#include "lib/path/scene_ray.cl"
#include "plain/light/environment.cl"
__kernel void draw(__global const Environment* environments, __global const float4* pixels,
                   __global const float* shares, __global const u32* cutpoints, __global float4* out, u32 count) {
  const u32 first = get_global_id(0) * LANES;
  if (first >= count) return;
  const Scene scene = {.environments = environments, .environment = pixels, .environment_shares = shares,
                       .environment_cutpoints = cutpoints};
  LaneSamples at = {(MASK)(3), (MASK)(5), NO_LANES};
  for (u32 i = 0; i < LANES; ++i) MASK_LANE(at.sample, i) = (int)(first + i);
  REAL u_x, u_y, v_x, v_y, density, again, sine, cosine;
  pair_lanes(&at, (MASK)(8), false, &u_x, &u_y);
  pair_lanes(&at, (MASK)(16), false, &v_x, &v_y);
  const REAL up = 1.0f - 2.0f * u_y, side = real_sqrt(real_max(1.0f - up * up, (REAL)(0.0f)));
  sincos_of_turn(u_x - 0.5f, &sine, &cosine, ALL_LANES);
  const REAL3 d = real3(side * cosine, up, side * sine);
  const REAL seen = environment_along(&scene, d, &density, ALL_LANES).x;
  const LightSamples s = sample_environment(&scene, v_x, v_y, ALL_LANES);
  environment_along(&scene, s.wi, &again, ALL_LANES);
  for (u32 i = 0; i < LANES; ++i) {
    out[2u * (first + i)] = (float4)(REAL_LANE(density, i), REAL_LANE(seen, i), REAL_LANE(d.y, i), 0.0f);
    out[2u * (first + i) + 1u] =
        (float4)(REAL_LANE(s.pdf, i), REAL_LANE(again, i), REAL_LANE(s.radiance.x, i) / REAL_LANE(s.pdf, i),
                 REAL_LANE(s.wi.y, i));
  }
}
)";

std::vector<float4> draw(const DeviceInfo& info, const EnvironmentDescription& e, u32 lanes = 1) {
  const Lights flat = compile_lights({.environment = &e});
  Device device(info);
  const KernelDefines defines{{"TILE_W", lanes == 1 ? "1" : "4"},
                              {"TILE_H", lanes == 1 ? "1" : "4"},
                              {"LANES", std::to_string(lanes)},
                              {"WIDE_VECTORS", "0"}};
  auto kernel =
      build_text(device, draw_kernel, defines)
          .kernel<Buffer<Environment>, Buffer<float4>, Buffer<float>, Buffer<u32>, Buffer<float4>, u32>(
              "draw");
  const auto environments = device.upload<Environment>(flat.environments);
  const auto pixels = device.upload<float4>(flat.environment);
  const auto shares = device.upload<float>(flat.environment_shares);
  const auto cutpoints = device.upload<u32>(flat.environment_cutpoints);
  const auto out = device.make<float4>(2 * count);
  device.run(kernel, {.x = count / lanes}, environments, pixels, shares, cutpoints, out, count);
  std::vector<float4> values(2 * count);
  device.read(out, std::span<float4>(values));
  return values;
}

/// The radiance that a ray along `d` sees.
dvec3 seen_along(const DeviceInfo& device, SceneDescription scene, const dvec3& d) {
  scene.camera.position = {0, 0, 0};
  scene.camera.target = d;
  scene.camera.up = std::abs(d.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  return scenes::pixel_on(device, scene);
}

SceneDescription floor_scene(int width) {
  SceneDescription scene = scenes::line_of_sight({1, 1, 0}, {0, 0, 0});
  scene.image.width = scene.image.height = width;
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  return scene;
}

double mean_of(const Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.data.size(); i += 4) sum += double(image.data[i]);
  return 4 * sum / double(image.data.size());
}

}  // namespace

TEST_CASE("the density of an environment's directions integrates to one and is that of its samples") {
  EnvironmentDescription sky;
  sky.type = EnvironmentType::sky;
  on_every_device([&](const DeviceInfo& device) {
    for (const EnvironmentDescription& e :
         {picture(1, 1, 0.5f), picture(2, 2, 0.2f, 1, 0, 3), picture(16, 8, 0, 0, 2, 50), picture(3, 1, 1),
          picture(4, 4, 0), sky}) {
      INFO(e.picture.width << " x " << e.picture.height);
      double integral = 0, light = 0, estimate = 0;
      std::size_t apart = 0;
      const std::vector<float4> drawn = draw(device, e);
      for (std::size_t i = 0; i < drawn.size(); i += 2) {
        const float4 &even = drawn[i], &sample = drawn[i + 1];
        integral += double(even.x) * 4 * pi / count;
        light += double(even.y) * 4 * pi / count;
        estimate += double(sample.z) / count;
        REQUIRE(sample.x > 0);
        apart += std::abs(sample.y / sample.x - 1) > 1e-3f;  // by rounding, on a cell's border
      }
      CHECK(integral == Approx(1).epsilon(0.02));
      CHECK(apart < drawn.size() / 200);
      CHECK(estimate == Approx(light).epsilon(0.02).margin(1e-6));
    }
  });
}

TEST_CASE("several directions of an environment at once are those that are drawn one by one") {
  EnvironmentDescription sky;
  sky.type = EnvironmentType::sky;
  EnvironmentDescription busy = picture(40, 20, 0.1f, 7, 4, 300);
  for (int i = 0; i < 40; ++i) busy.picture.pixel(i, 11)[0] = float(i);
  on_every_device([&](const DeviceInfo& device) {
    if (!wants_vectors(device)) return;  // draws one at a time, and compiles sixteen for half a minute
    for (const EnvironmentDescription& e : {busy, sky}) {
      const std::vector<float4> alone = draw(device, e), together = draw(device, e, 16);
      std::size_t apart = 0;
      for (std::size_t i = 1; i < alone.size(); i += 2)
        apart +=
            std::abs(together[i].x / alone[i].x - 1) > 1e-3f || std::abs(together[i].w - alone[i].w) > 1e-4f;
      CHECK(apart < alone.size() / 1000);  // by rounding, on a cell's border
    }
  });
}

TEST_CASE("a sun of one pixel is chosen as it is blended: the light over the density varies little") {
  on_every_device([&](const DeviceInfo& device) {
    const std::vector<float4> drawn = draw(device, picture(32, 16, 0, 20, 5, 100));
    double sum = 0, squares = 0;
    for (std::size_t i = 1; i < drawn.size(); i += 2) {
      sum += double(drawn[i].z) / count;
      squares += double(drawn[i].z) * double(drawn[i].z) / count;
    }
    // By the sine's change over half a pixel alone; were directions chosen evenly in quarters of pixels,
    // (1 + 1/9)^2 - 1, in closed form.
    CHECK(squares / (sum * sum) - 1 < 0.002);
  });
}

TEST_CASE("an environment is seen upright, its middle along -z, and turns counterclockwise") {
  SceneDescription scene = scenes::line_of_sight({0, 0, 0}, {0, 0, -1});
  scene.environment = picture(4, 1, 0);
  for (int x = 0; x < 4; ++x) scene.environment.picture.pixel(x, 0)[0] = float(x + 1);
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(seen_along(device, scene, {1, 0.2, -1}).x == Approx(3).epsilon(1e-4));
    CHECK(seen_along(device, scene, {-1, 0.2, -1}).x == Approx(2).epsilon(1e-4));
    CHECK(seen_along(device, scene, {1, -0.5, 1}).x == Approx(4).epsilon(1e-4));
    CHECK(seen_along(device, scene, {-1e-6, 0, 1}).x == Approx(2.5).epsilon(1e-3));  // across the seam
    SceneDescription turned = scene;
    turned.environment.rotate = 90;
    CHECK(seen_along(device, turned, {-1, 0.2, -1}).x == Approx(3).epsilon(1e-4));
    SceneDescription hidden = scene;
    hidden.environment.hidden = true;
    hidden.image.background_bottom = hidden.image.background_top = {0.25, 0, 0};
    CHECK(seen_along(device, hidden, {1, 0.2, -1}).x == Approx(0.25));
    SceneDescription high = scene;
    high.environment = picture(2, 2, 1, 0, 0, 1);
    for (int x = 0; x < 2; ++x) high.environment.picture.pixel(x, 0)[0] = 7;
    CHECK(seen_along(device, high, {0, 1, 0}).x == Approx(7).epsilon(1e-4));
  });
}

TEST_CASE("in a white environment a white surface is white, and so are mirrors and glass") {
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = floor_scene(8);
    scene.environment = picture(1, 1, 1);
    scene.environment.samples = 16;
    // A plane sees the upper half alone: half of the samples.
    CHECK(mean_of(scenes::render_on(device, scene).image) == Approx(1).epsilon(0.01));
    scene = scenes::line_of_sight({0, 0.3, 4}, {0, 0.1, 0});
    scene.environment = picture(1, 1, 1);
    scenes::place(scene, SphereShape{1}, scenes::add_mirror(scene, 1));
    CHECK(scenes::pixel_on(device, scene).x == Approx(1).epsilon(1e-4));
    scene.render.max_depth = 12;
    scene.objects.clear();
    scenes::place(scene, SphereShape{1}, scenes::add_dielectric(scene, 1.5));
    CHECK(scenes::pixel_on(device, scene).x == Approx(1).epsilon(1e-4));
  });
}

TEST_CASE("one bright pixel of an environment shines as a directional light does, and casts its shadow") {
  constexpr int width = 256, height = 128, x = 150, y = 20;
  const double zenith = pi * (y + 0.5) / height, azimuth = 2 * pi * (x + 0.5) / width - pi;
  const dvec3 to(std::sin(zenith) * std::sin(azimuth), std::cos(zenith),
                 -std::sin(zenith) * std::cos(azimuth));
  const double angle = 2 * pi / width * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = floor_scene(8);
    scene.environment = picture(width, height, 0, x, y, 1000);
    scene.environment.samples = 64;
    CHECK(mean_of(scenes::render_on(device, scene).image) == Approx(1000 * angle * to.y / pi).epsilon(0.02));
    scenes::place(scene, DiskShape{0.2, 0}, 0, glm::translate(glm::dmat4(1), to));
    CHECK(mean_of(scenes::render_on(device, scene).image) == 0);
  });
}

TEST_CASE("a directional light of some degrees across is as bright, is seen, and has a penumbra") {
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {0, -1, 0};
  sun.angle = 6;
  sun.samples = 8;
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = floor_scene(8);
    scene.lights.push_back(sun);
    CHECK(mean_of(scenes::render_on(device, scene).image) == Approx(1).epsilon(2e-3));
    // A box over x < 0, twenty up: half of the sun is behind its edge.
    scenes::place(scene, BoxShape{{5, 0.1, 5}}, 0, glm::translate(glm::dmat4(1), {-5, 20, 0}));
    CHECK(mean_of(scenes::render_on(device, scene).image) == Approx(0.5).epsilon(0.1));
    SceneDescription open = scenes::line_of_sight({0, 0, 0}, {0, 1, 0}, {1, 0, 0});
    open.lights.push_back(sun);
    open.lights.back().samples = 1;  // it lights nothing here: kernels with room for few lights serve
    const double radiance = 1 / std::pow(std::sin(glm::radians(3.0)), 2);
    CHECK(seen_along(device, open, {std::sin(glm::radians(2.9)), std::cos(glm::radians(2.9)), 0}).x ==
          Approx(radiance).epsilon(1e-4));
    CHECK(seen_along(device, open, {std::sin(glm::radians(3.1)), std::cos(glm::radians(3.1)), 0}).x == 0);
    open.lights.back().hidden = true;
    CHECK(seen_along(device, open, {0, 1, 0}).x == 0);
  });
}
