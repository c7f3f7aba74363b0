// The sky's model: blue above, brighter about the sun, redder as that sinks.
#include <cmath>
#include <numbers>

#include "catch.h"
#include "compile/sky.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double degree = std::numbers::pi / 180;

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
