// The figures of `sundog compare` against ones worked out by hand.
#include <base/image_compare.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "catch.h"

using namespace sundog;

namespace {

Image constant(int width, int height, float value) {
  Image image(width, height, 4);
  std::fill(image.data.begin(), image.data.end(), value);
  return image;
}

}  // namespace

TEST_CASE("equal images differ in nothing") {
  const Image image = constant(10, 10, 0.5f);
  const ImageDifference d = compare_images(image, image, 0);
  CHECK(d.max == 0);
  CHECK(d.mean == 0);
  CHECK(std::isinf(d.psnr));
  CHECK(d.differing == 0);
  CHECK(d.over_tolerance == 0);
  CHECK(d.pixels == 100);
}

TEST_CASE("one channel of one pixel gives the figures worked out by hand") {
  const Image a = constant(10, 10, 0.5f);
  Image b = a;
  b.pixel(3, 4)[1] = 0.75f;
  const ImageDifference d = compare_images(a, b, 0.25);
  CHECK(d.max == 0.25);
  CHECK(d.mean == Approx(0.25 / 300));
  CHECK(d.rms == Approx(0.25 / std::sqrt(300.0)));
  CHECK(d.psnr == Approx(-20 * std::log10(0.25 / std::sqrt(300.0))));
  CHECK(d.percentile_99 == 0);
  CHECK(d.differing == 1);
  CHECK(d.over_tolerance == 0);
  CHECK(compare_images(a, b, 0.24).over_tolerance == 1);
}

TEST_CASE("the 99th percentile leaves one pixel in a hundred out") {
  const Image a = constant(10, 20, 0);
  Image b = a;
  for (int i = 0; i < 3; ++i) b.pixel(i, 0)[0] = static_cast<float>(i + 1);
  CHECK(compare_images(a, b, 0).percentile_99 == 1);  // 197 zeros, then 1, 2, 3: the 198th of 200
}

TEST_CASE("alpha is compared where that is asked for") {
  const Image a = constant(2, 2, 0);
  Image b = a;
  b.pixel(0, 0)[3] = 1;
  CHECK(compare_images(a, b, 0).differing == 0);
  CHECK(compare_images(a, b, 0, 4).differing == 1);
  CHECK(compare_images(a, b, 0, 4).rms == Approx(std::sqrt(1.0 / 16)));
  CHECK(difference_image(a, b, 4).pixel(0, 0)[0] == 1);
  CHECK_THROWS_AS(compare_images(Image(2, 2, 3), b, 0, 4), std::invalid_argument);
}

TEST_CASE("values that are not finite differ from all others, and do not spoil the means") {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Image a = constant(2, 2, 0), b = a;
  a.pixel(0, 0)[0] = infinity;
  b.pixel(0, 0)[0] = infinity;
  a.pixel(1, 0)[0] = b.pixel(1, 0)[0] = nan;
  CHECK(compare_images(a, b, 0).differing == 0);
  b.pixel(0, 1)[2] = nan;
  const ImageDifference d = compare_images(a, b, 1e30);
  CHECK(d.over_tolerance == 1);
  CHECK(std::isinf(d.max));
  CHECK(d.mean == 0);
  CHECK(d.non_finite == 3);
}

TEST_CASE("images of different sizes cannot be compared") {
  CHECK_THROWS_AS(compare_images(constant(2, 3, 0), constant(3, 2, 0), 0), std::invalid_argument);
}

TEST_CASE("the difference picture is grey where the images agree and coloured by size where not") {
  const Image a = constant(4, 1, 0.5f);
  Image b = a;
  b.pixel(1, 0)[0] += 1e-6f;
  b.pixel(2, 0)[0] += 2;
  b.pixel(3, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  const Image shown = difference_image(a, b);
  CHECK(shown.pixel(0, 0)[0] == Approx(0.1));
  CHECK(shown.pixel(0, 0)[0] == shown.pixel(0, 0)[2]);
  CHECK(shown.pixel(1, 0)[2] == 1);
  CHECK(shown.pixel(1, 0)[0] == 0);
  CHECK(shown.pixel(2, 0)[0] == 1);
  CHECK(shown.pixel(2, 0)[1] == 0);
  CHECK((shown.pixel(3, 0)[0] == 1 && shown.pixel(3, 0)[1] == 0 && shown.pixel(3, 0)[2] == 1));
}
