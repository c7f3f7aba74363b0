// How different pictures look, and the time to an error.
#include <cmath>
#include <limits>

#include "bench/quality/perceived_difference.h"
#include "bench/report/samples.h"
#include "catch.h"

using namespace sundog;

namespace {

template <class Color>
Image picture(int width, int height, const Color& color) {
  Image image;
  image.width = width, image.height = height, image.channels = 4;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(color(x, y, c)));
      image.data.push_back(1);
    }
  return image;
}

}  // namespace

TEST_CASE("pictures look the same as themselves, black and white as different as can be") {
  const auto even = [](double value) { return picture(24, 20, [&](int, int, int) { return value; }); };
  CHECK(perceived_difference(even(0.4), even(0.4)) == 0);
  CHECK(perceived_difference(even(0), even(1)) > 0.9);
  CHECK(perceived_difference(even(0), even(1)) <= 1);
  CHECK(perceived_difference(even(1), even(7)) == 0);  // both white
  // Even pictures have no edges: the paper's own mapping of the distance of grey 0 and 0.1 in CIELab.
  const double lightness = 116 * std::cbrt(0.1) - 16;
  const double found = perceived_difference(even(0), even(0.1));
  CHECK(found > 0.3 * std::pow(lightness / 100, 0.7));
  CHECK(found < 1);
  const auto green = picture(24, 20, [](int, int, int c) { return c == 1 ? 1 : 0; });
  const auto blue = picture(24, 20, [](int, int, int c) { return c == 2 ? 1 : 0; });
  CHECK(std::abs(perceived_difference(green, blue) - 1) < 1e-6);  // the greatest distance there is
  const auto bad = picture(24, 20, [](int, int, int) { return std::numeric_limits<double>::quiet_NaN(); });
  CHECK(perceived_difference(bad, even(0)) == 0);
}

TEST_CASE("fine noise is seen less than the same difference in one piece, and colours less than lightness") {
  const auto grey = picture(64, 64, [](int, int, int) { return 0.3; });
  const auto noise = picture(64, 64, [](int x, int y, int) { return (x + y) % 2 ? 0.2 : 0.4; });
  const auto halves = picture(64, 64, [](int x, int, int) { return x < 32 ? 0.2 : 0.4; });
  CHECK(perceived_difference(grey, noise) < 0.7 * perceived_difference(grey, halves));
  CHECK(perceived_difference(grey, noise) > 0);
  // Fine stripes of blue and yellow blur for the eye before those of red and green do.
  const auto stripes = [](int channel) {
    return picture(64, 64, [=](int x, int, int c) { return c == channel && x / 2 % 2 ? 0.4 : 0.3; });
  };
  CHECK(perceived_difference(grey, stripes(2)) < perceived_difference(grey, stripes(1)));
}

TEST_CASE("the cost of an error lies between those measured, as a power of the error") {
  const std::vector<ErrorCost> measured{{0.4, 1}, {0.2, 4}, {0.1, 16}};
  CHECK(std::abs(cost_of_error(measured, 0.2) - 4) < 1e-9);
  CHECK(std::abs(cost_of_error(measured, 0.4 / 3) - 9) < 1e-9);
  CHECK(cost_of_error(measured, 0.5) == 0);
  CHECK(cost_of_error(measured, 0.05) == 0);
}
