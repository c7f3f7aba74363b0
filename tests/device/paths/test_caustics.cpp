// Photons: what lamps send onto glass and mirrors arrives elsewhere, where rays in double precision take it,
// as paths find it by chance, and to the same bits however the work is cut.
#include <atomic>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>

#include "base/environment.h"
#include "base/faults.h"
#include "compile/compiled_scene.h"
#include "path_testing.h"
#include "render/device/kernel_config.h"
#include "render/device/photon_maps.h"
#include "same_bits.h"
#include "temporary_folder.h"

using namespace sundog;
using namespace sundog::paths;

namespace {

constexpr double ball_height = 0.7, ball_radius = 0.5, lamp_height = 3, glass_index = 1.5;

enum Shining { of_point, of_spot, of_parallel, of_sun, of_rectangle, of_disk, of_sphere, of_sky, all_kinds };

// Every kind of light, of which one shines, so that all scenes have the same kernels.
void add_lights(SceneDescription& scene, Shining shining) {
  const auto add = [&](LightType type, const dvec3& position, double intensity) {
    scene.lights.push_back(
        lamp(type, position, static_cast<int>(scene.lights.size()) == shining ? intensity : 0));
    return &scene.lights.back();
  };
  add(LightType::point, {0, lamp_height, 0}, 4)->falloff = {0, 0, 1};
  add(LightType::spot, {0, lamp_height, 0}, 0.5)->direction = {0, -1, 0};
  add(LightType::directional, {}, 1)->direction = {0, -1, 0};
  LightDescription* sun = add(LightType::directional, {}, 3);
  sun->direction = {-0.3, -1, 0};
  sun->angle = 30;
  add(LightType::rectangle, {0.5, 2, 0}, 2)->size = {0.9, 0.6};
  add(LightType::disk, {0, 2.2, 0}, 3);
  add(LightType::sphere, {0.6, 2, 0.5}, 3)->radius = 0.4;
  scene.environment.type = EnvironmentType::gradient;
  scene.environment.intensity = shining == of_sky ? 1 : 0;
}

// A ball of glass over a floor, of which all pixels see the point (x, 0, 0).
SceneDescription ball_scene(Shining shining, double x, int samples) {
  SceneDescription scene = path_scene({x + 2, 0.6, 1.2}, {x, 0, 0}, samples);
  scene.render.caustics = true;
  scene.render.max_depth = 12;
  add_lights(scene, shining);
  scenes::place(scene, PlaneShape{}, add_matte(scene, 0.6));
  scenes::place(scene, SphereShape{ball_radius}, scenes::add_dielectric(scene, glass_index),
                glm::translate(glm::dmat4(1), dvec3(0, ball_height, 0)));
  return scene;
}

// A view of mist below the ball, where the light through it comes together over a black floor.
SceneDescription mist_scene(Shining shining, int samples) {
  SceneDescription scene = ball_scene(shining, -0.05, samples);
  scene.camera.target = {-0.05, 0.02, 0};
  scene.camera.fov = 6;
  scene.image.width = scene.image.height = 24;
  scene.render.photons = 65536;
  scene.render.photon_radius = 0.02;
  scene.materials[static_cast<std::size_t>(scene.objects[0].material)].diffuse = dvec3(0);
  scenes::place(scene, BoxShape{{1.5, 0.6, 1.5}}, scenes::add_dielectric(scene, 1, {0.1, 0.1, 0.1}, -1),
                glm::translate(glm::dmat4(1), {0, 0.6, 0}));
  scene.materials.back().shadow_filter = true;
  scene.media.back().scattering = {0.5, 0.3, 0.1};
  scene.media.back().anisotropy = 0.4;
  return scene;
}

double reflectance(double cos_i, double eta) {
  const double cos_t = std::sqrt(std::max(0.0, 1 - (1 - cos_i * cos_i) / (eta * eta)));
  const double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  const double p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  return 0.5 * (s * s + p * p);
}

// Where a ray from the lamp at the angle to the axis meets the floor, and the part of its light that is left.
struct Bent {
  double at = 0, kept = 0;
};
std::optional<Bent> through_ball(double angle) {
  const dvec3 o(0, lamp_height - ball_height, 0), d(std::sin(angle), -std::cos(angle), 0);
  const double b = glm::dot(o, d), rest = b * b - glm::dot(o, o) + ball_radius * ball_radius;
  if (rest <= 0) return std::nullopt;
  const dvec3 in = o + (-b - std::sqrt(rest)) * d, n = in / ball_radius;
  const double cos_i = -glm::dot(d, n);
  const dvec3 inside = glm::refract(d, n, 1 / glass_index);
  const dvec3 out = in - 2 * glm::dot(in, inside) * inside;
  const dvec3 after = glm::refract(inside, -out / ball_radius, glass_index);
  const double f = reflectance(cos_i, glass_index);
  if (after.y >= 0) return std::nullopt;
  return Bent{out.x + after.x * (-(out.y + ball_height) / after.y), (1 - f) * (1 - f)};
}

// The irradiance at x by rays in double precision, of those within `radius`.
double irradiance_by_rays(double x, double radius) {
  const double intensity = pi * 4;
  constexpr int turns = 600, angles = 6000;
  const double least = std::cos(std::asin(ball_radius / (lamp_height - ball_height)));
  double flux = 0;
  for (int i = 0; i < angles; ++i) {
    const std::optional<Bent> bent = through_ball(std::acos(1 - (1 - least) * (i + 0.5) / angles));
    if (!bent || std::abs(bent->at) > std::abs(x) + radius || std::abs(bent->at) < std::abs(x) - radius)
      continue;
    int within = 0;
    for (int k = 0; k < turns; ++k) {
      const double turn = 2 * pi * (k + 0.5) / turns;
      within += std::hypot(bent->at * std::cos(turn) - x, bent->at * std::sin(turn)) < radius;
    }
    flux += bent->kept * intensity * 2 * pi * (1 - least) / angles * within / turns;
  }
  return flux / (pi * radius * radius);
}

// The sum of what the photons of the first map bring.
dvec3 landed_flux(const DeviceInfo& info, const SceneDescription& scene) {
  const CompiledScene compiled = compile(scene);
  REQUIRE(compiled.features.caustics);
  Device device(info);
  RenderTimes times;
  FrameKernels kernels;  // without the integrator's, which takes as long to build
  kernels.config = make_kernel_config(compiled, info, {});
  kernels.tables = upload_scene(device, compiled);
  add_photon_tracer(device, kernels, times);
  PhotonMaps maps(compiled);
  LaunchWatch watch;
  REQUIRE(maps.prepare({device, kernels, watch}, {}, 0, 1));
  const auto read = [&]<class T>(const Buffer<T>& buffer) {
    std::vector<T> rows(buffer.count);
    device.read(buffer, std::span<T>(rows));
    return rows;
  };
  const PhotonMap map = read(kernels.tables.photon_maps).front();
  const std::vector<float4> photons = read(kernels.tables.photons);
  const u32 landed = read(kernels.tables.photon_cells)[map.cell_mask + 1];
  dvec3 sum(0);
  for (u32 i = 0; i < landed; ++i) {
    const float4& flux = photons[map.photons + i];
    sum += dvec3(flux.x, flux.y, flux.z);
  }
  return sum;
}

}  // namespace

TEST_CASE("photons bring all light of a lamp that meets glass onto the walls about it") {
  SceneDescription scene = path_scene({0, 0, 0.9}, {0, 0, 0}, 4);
  scene.render.caustics = true;
  add_lights(scene, of_point);
  scenes::place(scene, MeshShape{add_room(scene)}, add_matte(scene, 0.5),
                glm::scale(glm::dmat4(1), dvec3(4)));
  scenes::place(scene, SphereShape{ball_radius}, scenes::add_dielectric(scene, glass_index),
                glm::translate(glm::dmat4(1), dvec3(0.2, -0.4, 0)));
  const dvec3 to = scene.lights[0].position - dvec3(0.2, -0.4, 0);
  const double cap = 2 * pi * (1 - std::sqrt(1 - ball_radius * ball_radius / glm::dot(to, to)));
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(landed_flux(device, scene).x == Approx(4 * pi * cap).epsilon(0.005));
  });
}

TEST_CASE("light through a ball of glass arrives where rays in double precision take it") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double x : {0.0, 0.05, 0.1}) {
      SceneDescription scene = ball_scene(of_point, x, 32);
      scene.render.max_depth = 3;  // the two faces of the ball, and the floor
      scene.render.photon_radius = 0.05;
      const double expected = 0.6 / pi * irradiance_by_rays(x, 0.04);  // the mean radius of eight maps
      const double all = mean_on(device, scene).value.x;
      scene.render.caustics = false;  // what the floor has from itself, by the ball's reflection
      const double rest = mean_on(device, scene).value.x;
      CAPTURE(x, rest);
      CHECK(all - rest == Approx(expected).epsilon(0.03));
    }
  });
}

TEST_CASE("photons bring what paths find by chance, from every light that has an extent") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const Shining shining : {of_sun, of_rectangle, of_disk, of_sphere, of_sky}) {
      // All of a patch in the ball's shadow, so that it matters little what photons blur.
      SceneDescription scene = ball_scene(shining, -0.05, 32);
      scene.camera.fov = 16;
      scene.render.photons = 16384;
      scene.render.photon_radius = 0.04;
      for (LightDescription& light : scene.lights) light.hidden = false;
      add_lamps(scene);
      const Mean brought = mean_on(device, scene);
      scene.render.caustics = false;
      scene.render.samples = 512;
      const Mean met = mean_on(device, scene);
      CAPTURE(int(shining), brought.value.x, met.value.x);
      CHECK(brought.value.x == Approx(met.value.x).epsilon(0.04));
    }
  });
}

TEST_CASE("photons bring into mist what paths find there by chance") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const Shining shining : {of_sphere, of_rectangle, of_sun}) {
      SceneDescription scene = mist_scene(shining, 256);
      for (LightDescription& light : scene.lights) light.hidden = false;
      add_lamps(scene);
      const Mean brought = mean_on(device, scene);
      scene.render.caustics = false;
      scene.render.samples = 4096;
      const Mean met = mean_on(device, scene);
      for (const int i : {0, 1, 2}) {
        CAPTURE(int(shining), i);
        CHECK(brought.value[i] == Approx(met.value[i]).epsilon(0.04));
      }
    }
  });
}

TEST_CASE("lights without extent light mist behind glass") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const Shining shining : {of_point, of_spot, of_parallel}) {
      SceneDescription scene = mist_scene(shining, 64);
      INFO(int(shining));
      const double all = mean_on(device, scene).value.x;
      scene.render.caustics = false;
      CHECK(all > 1.2 * mean_on(device, scene).value.x);
    }
  });
}

TEST_CASE("no photons of suns and skies get through fog that has no end") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const Shining shining : {of_parallel, of_sun, of_sky, of_point}) {
      SceneDescription scene = ball_scene(shining, 0, 4);
      scene.render.photons = 4096;
      scene.fog.color = dvec3(0.8);
      scene.fog.density = 0.1;
      scene.fog.anisotropy = 0.3;
      INFO(int(shining));
      CHECK((mean_on(device, scene).value.x > 0) == (shining == of_point));
    }
  });
}

TEST_CASE("lights without extent light what is behind glass") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const Shining shining : {of_point, of_spot, of_parallel}) {
      SceneDescription scene = ball_scene(shining, 0, 4);
      scene.render.photons = 4096;
      INFO(int(shining));
      CHECK(mean_on(device, scene).value.x > 0.3);
      scene.render.caustics = false;
      CHECK(mean_on(device, scene).value.x < 0.02);
    }
  });
}

TEST_CASE("photons that miss what they were sent to bring nothing: shadow rays find their light") {
  on_picture_devices([&](const DeviceInfo& device) {
    // Beside the shadow of the box, and in that of the ball around it.
    SceneDescription scene = path_scene({1.05, 0.6, 2}, {1.05, 0, 0}, 16);
    scene.render.caustics = true;
    scene.render.photons = 4096;
    scene.render.max_depth = 1;
    add_lights(scene, of_point);
    scenes::place(scene, PlaneShape{}, add_matte(scene, 0.6));
    scenes::place(scene, BoxShape{dvec3(0.5)}, scenes::add_mirror(scene, 0.9),
                  glm::translate(glm::dmat4(1), dvec3(0, ball_height, 0)));
    const double d2 = 1.05 * 1.05 + lamp_height * lamp_height;
    check_mean(mean_on(device, scene), 0.6 * 4 * lamp_height / std::sqrt(d2) / d2);
  });
}

TEST_CASE("a picture with photons has the same bits however its work is cut, and after an interruption") {
  SceneDescription scene = ball_scene(of_point, 0, 9);
  scene.lights[of_sphere].intensity = 2;
  scene.camera.fov = 30;
  scene.image.width = 19;
  scene.image.height = 14;
  scene.render.photons = 5000;
  scene.render.sampler = SAMPLER_SOBOL;
  const DeviceInfo device = test_devices().front();
  const Image whole = scenes::render_on(device, scene).image;
  RenderOptions options;
  options.work_group = {WorkGroup::Kind::fixed, 3, 1};
  CHECK(same_bits(scenes::render_on(device, scene, options).image, whole));
  options.tile = 4;
  CHECK(same_bits(scenes::render_on(device, scene, options).image, whole));
  SceneDescription growing = scene;
  growing.render.sampling.progressive = true;
  CHECK(same_bits(scenes::render_on(device, growing).image, whole));
  if (device.max_sub_devices > 1) {
    DeviceInfo part = device;
    part.sub_units = 1;
    RenderOptions shared = options;
    shared.kernels = KernelChoice::general;  // those that are there
    CHECK(same_bits(render(compile(scene), {part, part}, shared).image, whole));
  }
  const TemporaryFolder folder;
  std::atomic<bool> stop{false};
  options.resume = folder.path() / "frame.checkpoint";
  options.stop = &stop;
  options.on_progress = [&](const RenderProgress& progress) {
    stop = progress.pixels_done > progress.pixels_total / 3;
  };
  REQUIRE_FALSE(scenes::render_on(device, scene, options).complete);
  options.stop = nullptr;
  options.on_progress = {};
  CHECK(same_bits(scenes::render_on(device, scene, options).image, whole));
}

TEST_CASE("a tile makes each map of photons once where not all have room, and the same bits") {
  SceneDescription scene = ball_scene(of_point, 0, 9);  // three maps
  scene.camera.fov = 30;
  scene.image.width = scene.image.height = 16;
  scene.render.photons = 5000;
  DeviceInfo device = test_devices().front();
  RenderOptions options;
  options.tile = 16;
  options.tuning = [](const DeviceInfo&) {
    Tuning short_launches;
    short_launches.launch_ms = 1e-3;
    return short_launches;
  };
  const RenderResult whole = render(compile(scene), {device}, options);
  CHECK(whole.devices.at(0).kernels.at("trace_photons").launches == 3);
  HostEnvironment environment = value_of(device.environment);
  environment.faults = std::make_shared<Faults>("photons=1@" + std::to_string(device.platform) + ":" +
                                                std::to_string(device.device));
  device.environment = std::make_shared<const HostEnvironment>(environment);
  const RenderResult narrow = render(compile(scene), {device}, options);
  CHECK(same_bits(narrow.image, whole.image));
  CHECK(narrow.devices.at(0).kernels.at("trace_photons").launches == 5);  // two had no room and came again
  CHECK(narrow.devices.at(0).kernels.at("render_path").launches > 12);
}

TEST_CASE("photons of a radius next to nothing, or wider than the scene, leave no sample out") {
  SceneDescription scene = ball_scene(of_point, 0, 4);
  scene.render.photons = 64;
  const DeviceInfo device = test_devices().front();
  for (const double radius : {1e-300, 1e-30, 1e-15, 1e15}) {
    CAPTURE(radius);
    scene.render.photon_radius = radius;
    CHECK(scenes::render_on(device, scene).counts[COUNT_NON_FINITE] == 0);
  }
}
