// Lights with an extent: what they send to a point in closed form, the density of their samples, what is seen
// of them, and their shadows.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

#include "catch.h"
#include "compile/parts/steps.h"
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
/// between a sample's density and that of its direction; and mean and deviation of the estimate by places on
/// the light, as photons start.
struct Estimate {
  float mean, deviation, density_error, by_place, place_deviation;
};

const char* const sample_kernel = R"(
#include "lib/core/sampler.cl"
#include "lib/light/light.cl"
typedef struct Lit { Light light; float4 p, n; } Lit;
typedef struct Estimate { float mean, deviation, density_error, by_place, place_deviation; } Estimate;
__kernel void run(__global const Lit* in, __global Estimate* out, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const Scene scene = {.lights = &in[i].light};
  const REAL3 p = all3(in[i].p.xyz), n = all3(in[i].n.xyz);
  float sum = 0.0f, squares = 0.0f, error = 0.0f, place_sum = 0.0f, place_squares = 0.0f;
  for (u32 k = 0; k < SIDE * SIDE; ++k) {
    const float u_x = ((float)(k % SIDE) + unit_float(hash_u32(2u * k + 77u * i))) / SIDE;
    const float u_y = ((float)(k / SIDE) + unit_float(hash_u32(2u * k + 1u + 77u * i))) / SIDE;
    const LightSamples s = sample_light(&scene, 0, p, u_x, u_y, ALL_LANES);
    const float value = s.radiance.x * max(dot3(s.wi, n), 0.0f) / s.pdf;
    sum += value;
    squares += value * value;
    const Emission from = emit_light(&in[i].light, u_x, u_y);
    const float3 way = from.p - in[i].p.xyz;
    const float3 wi = way * rsqrt(dot(way, way));
    const float sent = from.radiance.x * from.area * max(-dot(wi, from.n), 0.0f) * max(dot(wi, in[i].n.xyz), 0.0f) / dot(way, way);
    place_sum += sent;
    place_squares += sent * sent;
    if (s.radiance.x == 0.0f) continue;
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

std::vector<Estimate> estimate(const DeviceInfo& info, const std::vector<Lit>& lit) {
  Device device(info);
  const KernelDefines one_lane{{"TILE_W", "1"},
                               {"TILE_H", "1"},
                               {"LANES", "1"},
                               {"WIDE_VECTORS", "0"},
                               {"SIDE", std::to_string(side)}};
  return run_text<Estimate>(device, sample_kernel, lit, one_lane);
}

/// The light as kernels see it.
Light pack(const LightDescription& light) { return compile_lights({.lights = {&light, 1}}).lights.at(0); }

float4 pack(const dvec3& v) { return {float(v.x), float(v.y), float(v.z), 0}; }

/// Lambert's irradiance at p of a polygon of radiance 1 that lies above the surface of normal n.
double polygon_irradiance(const std::vector<dvec3>& corners, const dvec3& p, const dvec3& n) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const dvec3 a = glm::normalize(corners[i] - p), b = glm::normalize(corners[(i + 1) % corners.size()] - p);
    const dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across / sine, n);
  }
  return std::abs(sum) / 2;
}

/// The rectangle's corners, or those of a polygon that is all but the disk.
std::vector<dvec3> corners_of(const LightDescription& light) {
  const LampAxes axes = lamp_axes(light);
  std::vector<dvec3> corners;
  if (light.type == LightType::rectangle) {
    for (const auto& [a, b] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
      corners.push_back(light.position + a * axes.u + b * axes.v);
    return corners;
  }
  constexpr int count = 4096;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * pi * i / count;
    corners.push_back(light.position + std::cos(angle) * axes.u + std::sin(angle) * axes.v);
  }
  return corners;
}

double sphere_irradiance(const LightDescription& light, const dvec3& p, const dvec3& n) {
  const dvec3 to = light.position - p;
  const double d = glm::length(to);
  return pi * light.radius * light.radius / (d * d) * glm::dot(n, to / d);
}

double irradiance(const LightDescription& light, const dvec3& p, const dvec3& n) {
  switch (light.type) {
    case LightType::rectangle:
    case LightType::disk:
      return polygon_irradiance(corners_of(light), p, n);
    case LightType::sphere:
      return sphere_irradiance(light, p, n);
    case LightType::ambient:
    case LightType::directional:
    case LightType::point:
    case LightType::spot:
      break;
  }
  throw std::logic_error("a light without an extent");
}

LightDescription lamp(LightType type, const dvec3& direction) {
  LightDescription light;
  light.type = type;
  light.position = {0.3, 2, -0.2};
  light.direction = direction;
  light.size = {1.4, 0.6};
  light.radius = 0.7;
  return light;
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

/// Of the picture's red: the mean, and its standard error.
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
      // Of the mean of independent samples; those in a grid are nearer.
      const auto error = [&](float deviation) { return 3 * double(deviation) / side + 2e-4 * expected[i]; };
      CHECK(std::abs(double(found[i].mean) - expected[i]) < error(found[i].deviation));
      CHECK(std::abs(double(found[i].by_place) - expected[i]) < error(found[i].place_deviation));
      CHECK(expected[i] > 0);
      CHECK(found[i].density_error < 0.01);  // the distance, by which that of an area is found, ends short
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
