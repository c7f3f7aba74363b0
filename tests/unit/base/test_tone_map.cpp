// Tone mapping: closed forms of the curves, exposure and white balance.
#include <cmath>
#include <limits>

#include "base/tone_map.h"
#include "catch.h"

using namespace sundog;

namespace {

std::array<double, 3> mapped(const ToneMap& map, std::array<float, 3> color) {
  Image image(1, 1, 3);
  std::copy(color.begin(), color.end(), image.data.begin());
  apply(map, image);
  return {image.data[0], image.data[1], image.data[2]};
}

double grey(const ToneMap& map, float value) { return mapped(map, {value, value, value})[1]; }

}  // namespace

TEST_CASE("without a curve colours stay, and an exposure doubles them with each stop") {
  CHECK(mapped({}, {0.2f, 3, 0}) == std::array<double, 3>{0.2f, 3, 0});
  CHECK(grey({.exposure = 2}, 0.3f) == Approx(1.2));
  CHECK(grey({.exposure = -1}, 0.3f) == Approx(0.15));
}

TEST_CASE("tone curves have the values that their sources state") {
  CHECK(grey({.curve = ToneCurve::reinhard}, 1) == Approx(0.5));
  CHECK(grey({.curve = ToneCurve::reinhard}, 9) == Approx(0.9));
  CHECK(grey({.curve = ToneCurve::aces}, 1) == Approx(2.54 / 3.16));
  CHECK(grey({.curve = ToneCurve::aces, .exposure = 1}, 0.5f) == Approx(2.54 / 3.16));
  // 12.47393 stops below 1 of a range of 16.5: the polynomial there, as a screen shows it.
  CHECK(grey({.curve = ToneCurve::agx}, 1) == Approx(0.5894).epsilon(0.01));
}

TEST_CASE("tone curves keep grey grey, rise, and end at black and at most white") {
  const auto curve = GENERATE(ToneCurve::reinhard, ToneCurve::aces, ToneCurve::agx);
  double before = -1;
  for (float light = 1e-4f; light < 1e4f; light *= 1.5f) {
    const auto shown = mapped({.curve = curve}, {light, light, light});
    CAPTURE(light);
    CHECK(std::abs(shown[0] - shown[2]) < 2e-3);
    CHECK(shown[1] >= before - 1e-3);
    CHECK(shown[1] < 1.04);
    before = shown[1];
  }
  CHECK(before > 0.95);
  CHECK(grey({.curve = curve}, 0) < 1e-4);
}

TEST_CASE("the light of a lamp's temperature becomes white, and daylight stays") {
  // A black body of 3000 K and one of 6500 K in linear sRGB.
  const auto lamp = mapped({.white_balance = 3000}, {1, 0.4770f, 0.1537f});
  CHECK(lamp[0] == Approx(lamp[1]).epsilon(0.02));
  CHECK(lamp[2] == Approx(lamp[1]).epsilon(0.02));
  const auto day = mapped({.white_balance = 6504}, {1, 1, 1});
  for (const double channel : day) CHECK(channel == Approx(1).epsilon(0.06));
}

TEST_CASE("what is not finite stays, and so does alpha") {
  Image image(2, 1, 4);
  image.data = {std::numeric_limits<float>::infinity(), 0, 0, 0.25f, 1, 1, 1, 0.5f};
  apply({.curve = ToneCurve::aces}, image);
  CHECK(std::isinf(image.data[0]));
  CHECK(image.data[3] == 0.25f);
  CHECK(image.data[7] == 0.5f);
  CHECK(image.data[4] < 1);
}
