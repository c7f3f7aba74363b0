// Halos as the host traces them: the light's sum, where it gathers, its colours, and the sky that is made of
// it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "compile/halo/halo_map.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;

EnvironmentDescription sky_with(std::vector<HaloCrystals> crystals, double altitude = 20) {
  EnvironmentDescription e;
  e.type = EnvironmentType::halo;
  e.sun_altitude = altitude;
  e.halo.crystals = std::move(crystals);
  e.halo.rays = 80'000;
  e.halo.cells = 256;
  return e;
}

HaloMap map_of(const EnvironmentDescription& e) { return trace_halo(plan_halo(e)); }

dvec3 towards(double azimuth, double altitude) {
  const double a = azimuth * degree, h = altitude * degree;
  return {std::cos(h) * std::cos(a), std::cos(h) * std::sin(a), std::sin(h)};
}

/// The mean of a patch of the sky.
dvec3 patch(const HaloMap& map, double azimuth, double altitude, double half) {
  dvec3 sum(0);
  for (int j = -4; j <= 4; ++j)
    for (int i = -4; i <= 4; ++i)
      sum += halo_radiance(map, towards(azimuth + half * i / 4, altitude + half * j / 4));
  return sum / 81.0;
}

double luminance(const float4& c) {
  return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z);
}

SceneDescription scene_under(const EnvironmentDescription& e) {
  SceneDescription scene;
  scene.environment = e;
  return scene;
}

}  // namespace

TEST_CASE("crystals neither gain nor lose light") {
  for (const u32 shape : {HALO_PLATE, HALO_COLUMN, HALO_PARRY, HALO_RANDOM})
    for (const double altitude : {0.0, 35.0, 90.0}) {
      const HaloMap map = map_of(sky_with({{shape, 0.6, 3, 2, 1}}, altitude));
      INFO("shape " << shape << ", sun at " << altitude);
      CHECK(map.passed + map.turned + map.kept == Approx(1).margin(1e-4));
      CHECK(map.kept < 0.01);
      CHECK(map.passed > 0.05);
      dvec3 sum(0);
      for (std::size_t i = 0; i < map.cells.size(); i += 3)
        sum += dvec3(map.cells[i], map.cells[i + 1], map.cells[i + 2]);
      sum *= 4 * pi / (double(map.side) * map.side);
      for (int c = 0; c < 3; ++c) CHECK(sum[c] == Approx(1).margin(0.04));  // white in all
    }
}

TEST_CASE("a halo's map mirrors itself about the sun, and light gathers in sundogs and 120 degree parhelia") {
  const HaloMap map = map_of(sky_with({{HALO_PLATE, 0.3, 0.3, 0, 1}}));
  CHECK(patch(map, 30, 40, 1) == patch(map, -30, 40, 1));
  const double sundog = patch(map, 25.5, 20, 1).y;
  CHECK(sundog > 10 * patch(map, 21, 20, 1).y);
  CHECK(sundog > 5 * patch(map, 50, 20, 1).y);
  CHECK(sundog > 50 * patch(map, 25.5, 26, 1).y);
  const double parhelion = patch(map, 120, 20, 1).y;
  CHECK(parhelion > 3 * patch(map, 110, 20, 1).y);
  CHECK(parhelion > 3 * patch(map, 130, 20, 1).y);
}

TEST_CASE("a sundog is red towards the sun, and the circumzenithal arc below") {
  const HaloMap map = map_of(sky_with({{HALO_PLATE, 0.6, 0.3, 0, 1}}));
  const dvec3 inner = patch(map, 24.1, 20, 0.3), outer = patch(map, 27, 20, 0.5);
  CHECK(inner.x > 2 * inner.z);
  CHECK(outer.z > 0.9 * outer.x);
  // At 20 degrees it is 65.7 high in red light and 68.5 in violet.
  const dvec3 low = patch(map, 0, 65.7, 0.3), high = patch(map, 0, 67.6, 0.3);
  CHECK(low.x > 2 * low.z);
  CHECK(high.z > 2 * high.x);
}

TEST_CASE("light of a thin layer of crystals grows with its depth, and is finite everywhere") {
  CHECK(halo_depth(1e-4, 0.5, 0.25) == Approx(1e-4 / 0.25).epsilon(1e-3));
  CHECK(halo_depth(1e-4, 0.4, 0.4) == Approx(1e-4 / 0.4).epsilon(1e-3));
  CHECK(halo_depth(0.3, 0.4, 0.4) == Approx(halo_depth(0.3, 0.4, 0.401)).epsilon(0.01));
  for (const double depth : {0.0, 0.01, 1.0, 100.0})
    for (const double sun : {0.0, 0.3, 1.0})
      for (double up = 0; up <= 1; up += 0.1) {
        const double light = halo_depth(depth, sun, up);
        REQUIRE((std::isfinite(light) && light >= 0));
      }
}

TEST_CASE("a scene's halo lights its sky, and a map that was traced beforehand changes no byte of it") {
  EnvironmentDescription e = sky_with({{HALO_PLATE, 0.3, 1, 1, 1}});
  e.halo.cells = 128;
  e.halo.rays = 20'000;
  const CompiledScene traced = compile(scene_under(e));
  e.halo_map = std::make_shared<const HaloMap>(map_of(e));
  const CompiledScene given = compile(scene_under(e));
  CHECK(std::ranges::equal(traced.environment, given.environment));
  CHECK(std::ranges::equal(traced.environment_shares, given.environment_shares));
  REQUIRE(traced.environments[0].width == 256);
  EnvironmentDescription clear = e;
  clear.halo.optical_depth = 0;
  const CompiledScene without = compile(scene_under(clear));
  double more = 0;
  for (std::size_t i = 0; i < given.environment.size() / 2; ++i) {
    REQUIRE(luminance(given.environment[i]) >= luminance(without.environment[i]) * 0.99);
    more += double(given.environment[i].y - without.environment[i].y);
  }
  CHECK(more > 0);
  REQUIRE(given.lights.size() == 2);  // the sky, and the sun, which the cloud dims
  const double kept = std::exp(-e.halo.optical_depth / std::sin(20 * degree));
  CHECK(double(given.lights[1].color.x / without.lights[1].color.x) == Approx(kept).epsilon(1e-5));
}
