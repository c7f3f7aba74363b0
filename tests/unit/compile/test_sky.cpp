// The sky's model: blue above, brighter about the sun, redder as that sinks.
#include <cmath>
#include <numbers>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "compile/sky/sky.h"
#include "compile/sky/twilight.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double degree = std::numbers::pi / 180;

double candela(const dvec3& c) { return 20000 * (0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z); }

/// The illuminance of horizontal ground.
double lux(const Twilight& sky) {
  constexpr int rows = 60, columns = 48;
  double sum = 0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double zenith = 90 * degree * (i + 0.5) / rows, azimuth = 360 * degree * (j + 0.5) / columns;
      sum += candela(sky.radiance(zenith, azimuth)) * std::cos(zenith) * std::sin(zenith);
    }
  return sum * (90 * degree / rows) * (360 * degree / columns);
}

}  // namespace

TEST_CASE("a clear sky is blue, brighter about the sun and at the horizon than far from both") {
  const Sky sky(2.5, 40 * degree);
  const dvec3 zenith = sky.radiance(0, 50 * degree), by_sun = sky.radiance(50 * degree, 3 * degree),
              horizon = sky.radiance(88 * degree, 100 * degree),
              away = sky.radiance(40 * degree, 90 * degree);
  CHECK(zenith.z > 1.5 * zenith.x);
  CHECK(by_sun.y > 4 * zenith.y);
  CHECK(horizon.y > away.y);
  CHECK(horizon.z / horizon.x < zenith.z / zenith.x);
}

TEST_CASE("the sun is about white and 1 when high, red and weak when low, and hazy air takes more") {
  const dvec3 high = Sky(3, 60 * degree).sun_irradiance(), low = Sky(3, 3 * degree).sun_irradiance(),
              hazy = Sky(8, 60 * degree).sun_irradiance();
  CHECK(high.y == Approx(1.5).epsilon(0.2));
  CHECK(high.x < 1.3 * high.z);
  CHECK(low.x > 3 * low.z);
  CHECK(low.y < 0.3 * high.y);
  CHECK(hazy.y < 0.8 * high.y);
}

TEST_CASE("a sky is finite and not below 0 for every turbidity, sun and direction") {
  for (double turbidity = 2; turbidity <= 10; turbidity += 1)
    for (double height = 0; height <= 90; height += 10)
      for (double zenith = 0; zenith < 90; zenith += 6)
        for (double sun = 0; sun <= 180; sun += 15) {
          const dvec3 light = Sky(turbidity, height * degree).radiance(zenith * degree, sun * degree);
          for (int c = 0; c < 3; ++c) REQUIRE((std::isfinite(light[c]) && light[c] >= 0));
        }
}

TEST_CASE("twilight lights the ground as is tabulated for a clear sky") {
  // Lux by the sun's altitude: Explanatory Supplement to the Astronomical Almanac, 1992, after Brown 1952.
  const std::pair<double, double> known[] = {{0, 700}, {-6, 3.4}, {-12, 0.008}, {-18, 0.00065}};
  for (const auto& [altitude, expected] : known) {
    const double found = lux(Twilight(3, altitude * degree));
    CAPTURE(altitude, found);
    CHECK(found > expected / 1.6);
    CHECK(found < expected * 1.6);
  }
}

TEST_CASE("at dusk the sky is red where the sun is, and blue overhead, by ozone and not by air alone") {
  for (const double altitude : {-2.0, -4.0, -6.0}) {
    const Twilight sky(3, altitude * degree);
    const dvec3 low = sky.radiance(86 * degree, 0), zenith = sky.radiance(0, 0),
                behind = sky.radiance(80 * degree, 180 * degree);
    CAPTURE(altitude);
    CHECK(low.x > 1.3 * low.z);
    CHECK(zenith.z > 1.6 * zenith.y);
    CHECK(zenith.y > 1.3 * zenith.x);
    CHECK(candela(low) > 2 * candela(zenith));
    CHECK(candela(low) > 1.2 * candela(behind));
    CHECK(sky.radiance(70 * degree, 1) == sky.radiance(70 * degree, -1));
  }
}

TEST_CASE("the sky of a low sun meets that of dusk and that of the day") {
  EnvironmentDescription e;
  e.type = EnvironmentType::sky;
  const auto picture = [&](double altitude) {
    e.sun_altitude = altitude;
    SceneDescription scene;
    scene.environment = e;
    return compile(scene).environment;
  };
  for (const double altitude : {-18.0, -6.0, 0.0, 2.0, 4.0}) {
    const auto before = picture(altitude - (altitude > -18 ? 1e-4 : 0)), after = picture(altitude + 1e-4);
    REQUIRE(before.size() == after.size());
    double most = 0, most_apart = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      most = std::max(most, double(after[i].w));
      most_apart = std::max(most_apart, std::abs(double(after[i].w - before[i].w)) / double(after[i].w));
    }
    CAPTURE(altitude);
    CHECK(most > 0);
    CHECK(most_apart < 0.01);
  }
}

TEST_CASE("the sky keeps its colour down to the horizon, and the ground begins below it") {
  SceneDescription scene;
  scene.environment.type = EnvironmentType::sky;
  const auto pixels = compile(scene).environment;
  constexpr std::size_t columns = 512, horizon = 128 * columns;  // the first row below it
  for (std::size_t i = horizon; i < horizon + columns; ++i) REQUIRE(pixels[i].w == pixels[i - columns].w);
  CHECK(pixels[horizon + columns].w == pixels.at(horizon + 2 * columns).w);
  CHECK(pixels[horizon + columns].w < pixels[horizon].w);
}
