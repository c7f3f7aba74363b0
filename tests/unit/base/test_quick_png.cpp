// The quick PNG holds the pixels of the PNG that is written to files, to the bit.
#include "base/pixels/quick_png.h"

#include <cmath>
#include <limits>
#include <random>

#include "base/pixels/image_codecs.h"
#include "base/pixels/stored_image.h"
#include "catch.h"

using namespace sundog;

namespace {

std::uint8_t by_definition(float value) {
  const float unit = srgb_from_linear(value);
  return static_cast<std::uint8_t>(std::lround(255 * (unit > 0 ? std::min(unit, 1.0f) : 0.0f)));
}

}  // namespace

TEST_CASE("sRGB bytes by comparisons are those of the formula, on both sides of each step") {
  for (unsigned byte = 1; byte < 256; ++byte) {
    float value = linear_from_srgb((static_cast<float>(byte) - 0.5f) / 255);
    for (int i = 0; i < 40; ++i) value = std::nextafter(value, 0.0f);
    for (int i = 0; i < 80; ++i, value = std::nextafter(value, 1.0f))
      REQUIRE(srgb_byte(value) == by_definition(value));
  }
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    const float value =
        std::ldexp(std::uniform_real_distribution<float>(0.5f, 1)(random), -int(random() % 30));
    REQUIRE(srgb_byte(value) == by_definition(value));
  }
  const float inf = std::numeric_limits<float>::infinity();
  for (const float value : {0.0f, -0.0f, -1.0f, 1.0f, 1.5f, inf, -inf, std::nanf("")})
    CHECK(srgb_byte(value) == by_definition(value));
}

TEST_CASE("a quick PNG decodes to the pixels of the one for files") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-0.1f, 1.2f);
  for (const auto& [width, height] : {std::pair(1, 1), {3, 2}, {61, 47}}) {
    Image image(width, height, 4), opaque(width, height, 3);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < 4; ++c) {
          image.pixel(x, y)[c] = y % 2 ? any(random) : 0.01f * static_cast<float>(x);
          if (c < 3) opaque.pixel(x, y)[c] = image.pixel(x, y)[c];
        }
    const StoredImage quick = decode_png(encode_quick_png(image)), usual = decode_png(encode_png(opaque));
    REQUIRE(quick.width == width);
    REQUIRE(quick.height == height);
    CHECK(quick.channels == usual.channels);
    CHECK(quick.data == usual.data);
  }
  CHECK_THROWS(encode_quick_png(Image(2, 2, 1)));
}
