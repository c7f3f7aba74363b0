// Lights: what those of every row of kernels/shared/lights.h send to a point in closed form, by samples and
// as photons start. Area lights: the density of their samples, what is seen of them, and their shadows.
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

#include "catch.h"
#include "closed_irradiance.h"
#include "compile/steps.h"
#include "devices.h"
#include "every_kind.h"
#include "scene/kinds.h"
#include "scene/lamps.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi;
constexpr u32 side = 32;  // samples are side * side, one in each cell of a grid

/// A light, and a point with a normal that it shines on.
struct Lit {
  Light light{};
  float4 p, n;
};
/// Over the samples: mean and standard deviation of the irradiance's estimate, the greatest difference
/// between a sample's density and that of its direction (0 unless it is a placed area light); and mean and
/// deviation of the estimate by how photons start.
struct Estimate {
  float mean, deviation, density_error, by_place, place_deviation;
};

const char* const sample_kernel = R"(
#include "lib/pathtracer/steps.cl"
#include "plain/pathtracer/photon_start.cl"
typedef struct Lit { Light light; float4 p, n; } Lit;
typedef struct Estimate { float mean, deviation, density_error, by_place, place_deviation; } Estimate;
// The irradiance that a photon with this start brings; `s` is a sample of the light.
float sent_by(const Scene* scene, const Emissions* from, const LightSamples* s, REAL3 p, REAL3 n) {
  __global const Light* light = scene->lights;
  if (!has_place(light)) return from->radiance.x * max(-dot3(from->d, n), 0.0f);
  const REAL3 way = subtract3(from->p, p), wi = unit3(way);
  const float sent = from->radiance.x * max(dot3(wi, n), 0.0f) / dot3(way, way);
  return sent * (has_extent(light) ? from->area * max(-dot3(wi, from->n), 0.0f) : M_PI_F * s->radiance.x * s->distance * s->distance);
}
__kernel void run(__global const Lit* in, __global const Environment* environments, __global const float4* pixels,
                  __global const float* shares, __global const u32* cutpoints, __global Estimate* out, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const Scene scene = {.lights = &in[i].light, .environments = environments, .environment = pixels,
                       .environment_shares = shares, .environment_cutpoints = cutpoints};
  const REAL3 p = all3(in[i].p.xyz), n = all3(in[i].n.xyz);
  float sum = 0.0f, squares = 0.0f, error = 0.0f, place_sum = 0.0f, place_squares = 0.0f;
  for (u32 k = 0; k < SIDE * SIDE; ++k) {
    const float u_x = ((float)(k % SIDE) + unit_float(hash_u32(2u * k + 77u * i))) / SIDE;
    const float u_y = ((float)(k / SIDE) + unit_float(hash_u32(2u * k + 1u + 77u * i))) / SIDE;
    const LightSamples s = sample_light(&scene, 0, p, u_x, u_y, ALL_LANES);
    const float value = M_PI_F * s.radiance.x * max(dot3(s.wi, n), 0.0f) * light_weight(&s, ALL_LANES);
    sum += value;
    squares += value * value;
    const bool distant = in[i].light.kind == LIGHT_ENVIRONMENT;
    const Emissions from =
        distant ? emit_environment(&s, ALL_LANES) : emit_light(&in[i].light, u_x, u_y, ALL_LANES);
    const float sent = sent_by(&scene, &from, &s, p, n);
    place_sum += sent;
    place_squares += sent * sent;
    if (s.radiance.x == 0.0f || !has_extent(&in[i].light) || !has_place(&in[i].light)) continue;
    const float density = area_light_pdf(&in[i].light, p, s.wi, s.distance, ALL_LANES);
    error = max(error, fabs(density / s.pdf - 1.0f));
  }
  const float mean = sum / (SIDE * SIDE);
  out[i].mean = mean;
  out[i].deviation = sqrt(max(squares / (SIDE * SIDE) - mean * mean, 0.0f));
  out[i].density_error = error;
  out[i].by_place = place_sum / (SIDE * SIDE);
  out[i].place_deviation = sqrt(max(place_squares / (SIDE * SIDE) - out[i].by_place * out[i].by_place, 0.0f));
}
)";

/// The radiance of the environment straight down and straight up; it changes evenly with the height.
constexpr double below = 0.5, above = 2;

Lights environment() {
  EnvironmentDescription sky;
  sky.type = EnvironmentType::gradient;
  sky.bottom = dvec3(below);
  sky.top = dvec3(above);
  return compile_lights({.environment = &sky});
}

std::vector<Estimate> estimate(const DeviceInfo& info, const std::vector<Lit>& lit) {
  Device device(info);
  const KernelDefines one_lane{{"TILE_W", "1"},
                               {"TILE_H", "1"},
                               {"LANES", "1"},
                               {"WIDE_VECTORS", "0"},
                               {"SIDE", std::to_string(side)}};
  auto kernel = build_text(device, sample_kernel, one_lane)
                    .kernel<Buffer<Lit>, Buffer<Environment>, Buffer<float4>, Buffer<float>, Buffer<u32>,
                            Buffer<Estimate>, u32>("run");
  const Lights flat = environment();
  const auto out = device.make<Estimate>(lit.size());
  device.run(kernel, {.x = lit.size()}, device.upload<Lit>(lit),
             device.upload<Environment>(flat.environments), device.upload<float4>(flat.environment),
             device.upload<float>(flat.environment_shares), device.upload<u32>(flat.environment_cutpoints),
             out, static_cast<u32>(lit.size()));
  std::vector<Estimate> estimates(lit.size());
  device.read(out, std::span<Estimate>(estimates));
  return estimates;
}

/// The light as kernels see it.
Light pack(const LightDescription& light) { return compile_lights({.lights = {&light, 1}}).lights.at(0); }

float4 pack(const dvec3& v) { return {float(v.x), float(v.y), float(v.z), 0}; }

LightDescription lamp(LightType type, const dvec3& direction) {
  LightDescription light;
  light.type = type;
  light.position = {0.3, 2, -0.2};
  light.direction = direction;
  light.size = {1.4, 0.6};
  light.radius = 0.7;
  return light;
}

/// A light, and the irradiance that it gives to a point p with a normal n that sees all of it.
struct Row {
  Light light{};
  std::function<double(const dvec3& p, const dvec3& n)> irradiance;
};

Row row_of(const LightDescription& light) {
  return {pack(light), [light](const dvec3& p, const dvec3& n) { return irradiance(light, p, n); }};
}

/// A delta light, by the part of it that is left at the distance and at the angle.
Row row_of(LightDescription light, double part) {
  light.falloff = {0.5, 0.25, 0.1};
  light.range = 9;
  light.intensity = 3;
  const auto irradiance_at = [light, part](const dvec3& p, const dvec3& n) {
    const dvec3 to = light.position - p;
    const double d = glm::length(to), near = 1 - std::pow(d / light.range, 4);
    return part * pi * light.intensity * near * glm::dot(to / d, n) /
           (light.falloff.x + light.falloff.y * d + light.falloff.z * d * d);
  };
  return {pack(light), irradiance_at};
}

Row row_of_triangle() {
  const std::vector<dvec3> corners{{-0.5, 2, -0.4}, {0.2, 2.2, 0.7}, {0.9, 1.9, -0.3}};
  const dvec3 u = corners[1] - corners[0], v = corners[2] - corners[0], across = glm::cross(v, u);
  Row row;
  row.light.kind = LIGHT_TRIANGLE;
  row.light.position = pack(corners[0]);
  row.light.edge_u = pack(u), row.light.edge_u.w = float(glm::length(u));
  row.light.edge_v = pack(v), row.light.edge_v.w = float(glm::length(v));
  row.light.direction = pack(glm::normalize(across)), row.light.direction.w = float(glm::length(across) / 2);
  row.light.color = {1, 1, 1, 0};
  row.irradiance = [corners](const dvec3& p, const dvec3& n) { return polygon_irradiance(corners, p, n); };
  return row;
}

/// One of each kind: the compiler asks for that of a new one.
Row row_of(LightKind kind) {
  const dvec3 down(0.1, -1, 0.05);
  LightDescription parallel = lamp(LightType::directional, down);
  const auto turned = [&](const dvec3&, const dvec3& n) { return -pi * glm::dot(glm::normalize(down), n); };
  switch (kind) {
    case LIGHT_DIRECTIONAL:
      return {pack(parallel), turned};
    case LIGHT_POINT:
      return row_of(lamp(LightType::point, down), 1);
    case LIGHT_SPOT: {
      LightDescription spot = lamp(LightType::spot, down);
      spot.inner_angle = 80, spot.outer_angle = 89;
      return row_of(spot, 1);
    }
    case LIGHT_RECTANGLE:
      return row_of(lamp(LightType::rectangle, down));
    case LIGHT_DISK:
      return row_of(lamp(LightType::disk, down));
    case LIGHT_SPHERE:
      return row_of(lamp(LightType::sphere, down));
    case LIGHT_SUN:
      parallel.angle = 20;
      return {pack(parallel), turned};
    case LIGHT_TRIANGLE:
      return row_of_triangle();
    case LIGHT_ENVIRONMENT:
      return {environment().lights.at(0), [](const dvec3&, const dvec3& n) {
                return pi * ((below + above) / 2 + (above - below) / 3 * n.y);
              }};
  }
  throw std::logic_error("a light without a case");
}

/// A white floor seen at the origin, 256 times, under a lamp that cannot be seen.
SceneDescription floor_under(LightDescription light) {
  SceneDescription scene = scenes::line_of_sight({1, 1, 0}, {0, 0, 0});
  scene.image.width = scene.image.height = 16;
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  light.hidden = true;
  scene.lights.push_back(light);
  return scene;
}

/// The mean of the picture's red, and its standard error.
std::pair<double, double> mean_of(const Image& image) {
  double sum = 0, squares = 0;
  const std::size_t count = image.data.size() / 4;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = double(image.data[4 * i]);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / double(count), variance = std::max(squares / double(count) - mean * mean, 0.0);
  return {mean, std::sqrt(variance / double(count))};
}

}  // namespace

TEST_CASE("the irradiance of lights with an extent is that of their closed forms") {
  std::vector<Lit> lit;
  std::vector<double> expected;
  for (const LightDescription& kind : every_area_light())
    for (const dvec3& direction : {dvec3(0, -1, 0), dvec3(0.8, -1, 0.3), dvec3(1, -0.1, 0)})
      for (const double distance : {1.0, 3.0, 40.0})
        for (const dvec3& normal : {dvec3(0, 1, 0), dvec3(0.3, 0.8, -0.1)}) {
          const LightDescription light = lamp(kind.type, direction);
          const dvec3 p = light.position + distance * glm::normalize(dvec3(0.25, -1, 0.1)),
                      n = glm::normalize(normal);
          lit.push_back({pack(light), pack(p), pack(n)});
          expected.push_back(irradiance(light, p, n));
        }
  on_every_device([&](const DeviceInfo& info) {
    const std::vector<Estimate> found = estimate(info, lit);
    for (std::size_t i = 0; i < found.size(); ++i) {
      INFO(i << ": " << found[i].mean << " for " << expected[i]);
      // The error of the mean of independent samples; samples in a grid are nearer.
      const auto error = [&](float deviation) { return 3 * double(deviation) / side + 2e-4 * expected[i]; };
      CHECK(std::abs(double(found[i].mean) - expected[i]) < error(found[i].deviation));
      CHECK(std::abs(double(found[i].by_place) - expected[i]) < error(found[i].place_deviation));
      CHECK(expected[i] > 0);
      CHECK(found[i].density_error < 0.01);  // the distance, by which that of an area is found, ends short
    }
  });
}

TEST_CASE("the light of every row is that of its closed form, by samples and as photons start") {
  std::vector<Lit> lit;
  std::vector<double> expected;
  for (u32 kind = 0; kind <= LIGHT_ENVIRONMENT; ++kind) {
    const Row row = row_of(static_cast<LightKind>(kind));
    REQUIRE(row.light.kind == kind);
    for (const dvec3& p : {dvec3(0), dvec3(0.8, -1, 0.5)})
      for (const dvec3& n : {dvec3(0, 1, 0), glm::normalize(dvec3(0.3, 0.8, -0.1))}) {
        lit.push_back({row.light, pack(p), pack(n)});
        expected.push_back(row.irradiance(p, n));
      }
  }
  on_every_device([&](const DeviceInfo& info) {
    const std::vector<Estimate> found = estimate(info, lit);
    for (std::size_t i = 0; i < found.size(); ++i) {
      INFO("kind " << lit[i].light.kind << ": " << found[i].mean << " for " << expected[i]);
      const auto error = [&](float deviation) { return 3 * double(deviation) / side + 5e-4 * expected[i]; };
      CHECK(expected[i] > 0);
      CHECK(std::abs(double(found[i].mean) - expected[i]) < error(found[i].deviation));
      CHECK(std::abs(double(found[i].by_place) - expected[i]) < error(found[i].place_deviation));
      CHECK(found[i].density_error < 0.01);
    }
  });
}

TEST_CASE("a rectangle close by is sampled by its solid angle: only the cosine varies") {
  const LightDescription light = lamp(LightType::rectangle, {0, -1, 0});
  const dvec3 p = light.position - dvec3(0, 0.2, 0);
  on_every_device([&](const DeviceInfo& info) {
    const Estimate found = estimate(info, {{pack(light), pack(p), {0, 1, 0, 0}}}).front();
    CHECK(double(found.mean) == Approx(irradiance(light, p, {0, 1, 0})).epsilon(2e-3));
    CHECK(found.deviation < 0.35f * found.mean);  // by area it is 1.5 times the mean
  });
}

TEST_CASE("points behind a flat light, inside a sphere and in a light's plane receive nothing") {
  const LightDescription rectangle = lamp(LightType::rectangle, {0, -1, 0}),
                         disk = lamp(LightType::disk, {0, -1, 0}), sphere = lamp(LightType::sphere, {});
  const float4 up{0, 1, 0, 0}, down{0, -1, 0, 0};
  const dvec3 middle = rectangle.position;
  const std::vector<Lit> lit{{pack(rectangle), pack(middle + dvec3(0, 1, 0)), down},
                             {pack(disk), pack(middle + dvec3(0, 1, 0)), down},
                             {pack(sphere), pack(middle + dvec3(0, 0.3, 0)), up},
                             {pack(rectangle), pack(middle + dvec3(3, 0, 0)), up},
                             {pack(rectangle), pack(middle), up},
                             {pack(disk), pack(middle), up}};
  on_every_device([&](const DeviceInfo& info) {
    const std::vector<Estimate> found = estimate(info, lit);
    for (std::size_t i = 0; i < found.size(); ++i) {
      INFO(i);
      CHECK(std::abs(found[i].mean) < 1e-5f);
    }
  });
}

TEST_CASE("a floor has the irradiance over pi, and half behind what covers half of the light") {
  LightDescription light;
  light.type = LightType::rectangle;
  light.position = {0, 2, 0};
  light.size = {2, 1};
  light.intensity = 3;
  const double whole = 3 * irradiance(light, {0, 0, 0}, {0, 1, 0}) / pi;
  on_picture_devices([&](const DeviceInfo& device) {
    for (const int samples : {1, 4})
      for (const bool covered : {false, true}) {
        light.samples = samples;
        SceneDescription scene = floor_under(light);
        // The camera looks from x = 1; the box is over x < 0.
        if (covered)
          scenes::place(scene, BoxShape{{5, 0.1, 5}}, 0, glm::translate(glm::dmat4(1), {-5, 1, 0}));
        const auto [mean, error] = mean_of(scenes::render_on(device, scene).image);
        INFO(samples << (covered ? " covered " : " open ") << mean << " +- " << error);
        CHECK(std::abs(mean - (covered ? whole / 2 : whole)) < 3 * error + 1e-6);
        CHECK(error < (covered ? 0.1 : 0.02) * whole / samples);  // about 256 times as many samples
      }
  });
}

TEST_CASE("a visible lamp shows its radiance from the front, is black behind, and shadows start behind it") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const LightDescription& kind : every_area_light()) {
      if (!facts_of(kind.type).can_be_met()) continue;
      LightDescription light = lamp(kind.type, {0, 0, 1});
      light.position = {0, 0, 0};
      light.color = {1, 0.5, 0.25};
      light.intensity = 8;
      const auto seen_from = [&](const dvec3& from) {
        SceneDescription scene = scenes::line_of_sight(from, {0.1, 0.05, 0});
        scene.lights.push_back(light);
        add_lamps(scene);
        return scenes::pixel_on(device, scene);
      };
      INFO(facts_of(kind.type).name);
      const dvec3 front = seen_from({1, 1, 3}), back = seen_from({1, 1, -3});
      CHECK(front.x == Approx(8));
      CHECK(front.z == Approx(2));
      CHECK(back.x == (facts_of(kind.type).aimed ? Approx(0) : Approx(8)));
    }
    LightDescription light = lamp(LightType::sphere, {});
    SceneDescription scene = floor_under(light);
    const auto [without, error] = mean_of(scenes::render_on(device, scene).image);
    scene.lights.back().hidden = false;
    add_lamps(scene);
    CHECK(mean_of(scenes::render_on(device, scene).image).first == Approx(without).epsilon(1e-6));
  });
}
