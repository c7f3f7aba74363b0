// Tone mapping: closed forms of the curves, exposure and white balance.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/image_io.h"
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
  // AgX's sigmoid over log2(light / 0.18) from -10 to 6.5, as the file has it.
  const auto agx = [](float value) {
    return 255 * srgb_from_linear(float(grey({.curve = ToneCurve::agx}, value)));
  };
  CHECK(agx(0.18f) == Approx(127.5).epsilon(1e-4));
  CHECK(agx(0.01f) == Approx(24.52).margin(0.05));
  CHECK(agx(0.18f * 90.51f) == Approx(255).epsilon(1e-3));
  CHECK(agx(0.0001f) < 0.5f);
}

TEST_CASE("aces is the transform of ACES 1.3, by the figures of OpenColorIO") {
  // "ACES 1.0 - SDR Video" for "sRGB - Display" of cg-config-v2.1.0_aces-v1.3_ocio-v2.3, from linear sRGB.
  struct Figure {
    std::array<float, 3> scene;
    std::array<double, 3> file;  // 0 to 1, as sRGB
  };
  const Figure figures[] = {{{0.18f, 0.18f, 0.18f}, {0.35595, 0.35595, 0.35595}},
                            {{1, 1, 1}, {0.81197, 0.81198, 0.81197}},
                            {{0.01f, 0.01f, 0.01f}, {0.01284, 0.01284, 0.01284}},
                            {{16, 16, 16}, {0.99974, 0.99974, 0.99974}},
                            {{100, 100, 100}, {1.02117, 1.02117, 1.02117}},
                            {{10, 0, 0}, {1.07967, 0.74495, 0.42385}},
                            {{0, 10, 0}, {0.93185, 0.99316, 0.84468}},
                            {{0, 0, 10}, {0.71607, 0.24304, 1.0283}},
                            {{0.5f, 0.1f, 0.02f}, {0.60366, 0.23985, 0.07529}},
                            {{0.05f, 0.2f, 0.6f}, {0.08328, 0.38273, 0.68814}},
                            {{0.8f, 0.3f, 0.3f}, {0.75105, 0.51489, 0.50624}},
                            {{2, 1, 0.2f}, {0.92138, 0.81819, 0.51433}}};
  for (const Figure& figure : figures) {
    const auto shown = mapped({.curve = ToneCurve::aces}, figure.scene);
    CAPTURE(figure.scene, shown);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(srgb_from_linear(float(shown[i])) == Approx(figure.file[i]).margin(0.002));
  }
}

TEST_CASE("tone curves keep grey grey, rise, and end at black and at most white") {
  const auto curve = GENERATE(ToneCurve::reinhard, ToneCurve::aces, ToneCurve::agx);
  double before = -1;
  for (float light = 1e-4f; light < 1e4f; light *= 1.5f) {
    const auto shown = mapped({.curve = curve}, {light, light, light});
    CAPTURE(light);
    CHECK(std::abs(shown[0] - shown[2]) < 2e-3);
    CHECK(shown[1] >= before - 1e-3);
    CHECK(shown[1] < 1.1);
    before = shown[1];
  }
  CHECK(before > 0.95);
  CHECK(grey({.curve = curve}, 0) < 1e-3);
}

TEST_CASE("the light of a lamp's temperature becomes white, and daylight stays") {
  // A black body of 3000 K and one of 6500 K in linear sRGB.
  const auto lamp = mapped({.white_balance = 3000}, {1, 0.4770f, 0.1537f});
  CHECK(lamp[0] == Approx(lamp[1]).epsilon(0.02));
  CHECK(lamp[2] == Approx(lamp[1]).epsilon(0.02));
  const auto day = mapped({.white_balance = 6504}, {1, 1, 1});
  for (const double channel : day) CHECK(channel == Approx(1).epsilon(1e-3));
  // No jump where lamps become daylight.
  for (double kelvin = 3000; kelvin < greatest_white; kelvin *= 1.005) {
    const auto here = mapped({.white_balance = kelvin}, {1, 1, 1}),
               next = mapped({.white_balance = kelvin * 1.005}, {1, 1, 1});
    for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(next[i] / here[i] - 1) < 0.03);
  }
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

TEST_CASE(
    "the automatic exposure makes the middle of a picture grey, whatever lamps and black parts it has") {
  Image image(10, 10, 3);
  // 80 pixels about 4 * 0.18 by their logarithms, 10 of a lamp, 10 nearly black, and one that is not finite.
  for (std::size_t i = 0; i < 100; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      image.data[3 * i + c] = i < 10 ? 1e-6f : i >= 90 ? 1e4f : i % 2 ? 0.36f : 1.44f;
  CHECK(automatic_exposure(image) == Approx(-2).margin(1e-4));
  CHECK(automatic_exposure(Image(3, 3, 3)) == 0);
  Image grey = image, set = image;
  apply({.automatic = true}, grey);
  apply({.exposure = automatic_exposure(image)}, set);
  CHECK(grey.data == set.data);
}

TEST_CASE("contrast has its slope at middle grey and keeps the ends") {
  const auto coded = [](double contrast, double value) {
    return double(srgb_from_linear(float(grey({.contrast = contrast}, linear_from_srgb(float(value))))));
  };
  for (const double contrast : {0.5, 1.5, 3.0}) {
    CHECK(coded(contrast, 0) == Approx(0).margin(1e-6));
    CHECK(coded(contrast, 0.5) == Approx(0.5).margin(1e-4));
    CHECK(coded(contrast, 1) == Approx(1).margin(1e-3));
    CHECK((coded(contrast, 0.505) - coded(contrast, 0.495)) / 0.01 == Approx(contrast).epsilon(0.02));
    CHECK(coded(contrast, 0.2) == Approx(std::pow(0.4, contrast) / 2).margin(1e-4));
  }
}

TEST_CASE("a vignette takes its share in the corners and nothing in the middle") {
  Image image(101, 51, 3);
  std::ranges::fill(image.data, 2.0f);
  apply({.vignette = 0.5}, image);
  CHECK(image.pixel(50, 25)[1] == 2);
  CHECK(image.pixel(0, 0)[1] == Approx(1).margin(0.03));
  CHECK(image.pixel(0, 0)[1] == image.pixel(100, 50)[1]);
  CHECK(double(image.pixel(0, 25)[1]) == Approx(2 - 2500 / 3200.5).margin(1e-3));
}

TEST_CASE("bloom spreads a lamp evenly and keeps its light") {
  Image image(201, 201, 4);
  float* lamp = &image.data[4 * (100 * 201 + 100)];
  lamp[0] = 1000;
  lamp[3] = 0.5f;
  const float dark = std::numeric_limits<float>::quiet_NaN();
  image.data[1] = dark;
  apply({.bloom = 0.2}, image);
  double sum = 0, spread = 0;
  for (int y = 0; y < 201; ++y)
    for (int x = 0; x < 201; ++x) {
      sum += double(image.pixel(x, y)[0]);
      if (x != 100 || y != 100) spread += double(image.pixel(x, y)[0]);
    }
  CHECK(sum == Approx(1000).epsilon(0.01));
  CHECK(spread < 200);
  CHECK(spread > 150);
  CHECK(image.pixel(90, 100)[0] == Approx(image.pixel(110, 100)[0]));
  CHECK(image.pixel(100, 90)[0] == Approx(image.pixel(110, 100)[0]));
  CHECK(image.pixel(105, 100)[0] > image.pixel(115, 100)[0]);
  CHECK(image.pixel(100, 100)[3] == 0.5f);
  CHECK(std::isnan(image.data[1]));
}
