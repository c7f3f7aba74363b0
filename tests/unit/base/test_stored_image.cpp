// Images as textures take them: the formats, the precision of samples, smaller levels, and hostile files.
#include <base/image_io.h>
#include <base/pixels/stored_image.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <string>

#include "catch.h"
#include "smaller_levels.h"

using namespace sundog;

namespace {

std::string word(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFF);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& content) {
  const std::string whole = type + content;
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(whole.data()), static_cast<uInt>(whole.size()));
  return word(static_cast<std::uint32_t>(content.size())) + whole + word(static_cast<std::uint32_t>(crc));
}

std::string deflated(const std::string& raw) {
  std::string packed(compressBound(raw.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
           raw.size());
  packed.resize(size);
  return packed;
}

/// A PNG of these rows (each behind its filter's byte), with whatever its header says.
std::string png(std::uint32_t width, std::uint32_t height, char depth, char color, const std::string& rows,
                const std::string& before = "") {
  const std::string header = word(width) + word(height) + depth + color + std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + before + chunk("IDAT", deflated(rows)) +
         chunk("IEND", "");
}

std::string error_of(const std::string& bytes) {
  try {
    decode_stored(bytes);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

double mean_of(const StoredImage& image, bool srgb) {
  double sum = 0;
  for (const std::uint8_t byte : image.data)
    sum += srgb ? double(linear_from_srgb(static_cast<float>(byte) / 255)) : byte / 255.0;
  return sum / static_cast<double>(image.data.size());
}

}  // namespace

TEST_CASE("a PNG keeps grey grey, eight bits eight bits, and sixteen bits whole") {
  const StoredImage grey = decode_stored(png(2, 1, 8, 0, std::string("\0\x10\xF0", 3)));
  CHECK(grey.channels == 1);
  CHECK(grey.data == std::vector<std::uint8_t>{0x10, 0xF0});
  const StoredImage colour = decode_stored(png(1, 1, 8, 2, std::string("\0\1\2\3", 4)));
  CHECK(colour.data == std::vector<std::uint8_t>{1, 2, 3, 255});
  const StoredImage height = decode_stored(png(1, 2, 16, 0, std::string("\0\x12\x34\0\xAB\xCD", 6)));
  CHECK(height.sample == StoredImage::Sample::word);
  std::uint16_t words[2];
  std::memcpy(words, height.data.data(), 4);
  CHECK(words[0] == 0x1234);
  CHECK(words[1] == 0xABCD);
  const StoredImage bits = decode_stored(png(8, 1, 1, 0, std::string("\0\xA5", 2)));
  CHECK(bits.data == std::vector<std::uint8_t>{255, 0, 255, 0, 0, 255, 0, 255});
}

TEST_CASE("a grey PNG with a transparent value has alpha") {
  const StoredImage image =
      decode_stored(png(2, 1, 8, 0, std::string("\0\x10\xF0", 3), chunk("tRNS", std::string("\0\x10", 2))));
  CHECK(image.channels == 4);
  CHECK(image.data == std::vector<std::uint8_t>{0x10, 0x10, 0x10, 0, 0xF0, 0xF0, 0xF0, 255});
}

TEST_CASE("hostile images are errors, in little memory and time") {
  const std::string good = png(64, 64, 8, 2, std::string(64 * (64 * 3 + 1), '\0'));
  CHECK(error_of(good).empty());
  CHECK(error_of(good.substr(0, good.size() / 2)) != "");
  CHECK(error_of(good.substr(0, 20)) != "");
  std::string flipped = good;
  flipped[20] ^= 1;  // in the header, whose sum is then wrong
  CHECK(error_of(flipped) != "");
  // Headers that lie: of sizes that the bytes cannot hold, of none, beyond all limits.
  CHECK_THAT(error_of(png(16384, 16384, 8, 6, "x")), ContainsSubstring("16384x16384 pixels"));
  CHECK(error_of(png(0, 4, 8, 2, "x")) != "");
  CHECK(error_of(png(0x7FFFFFFF, 0x7FFFFFFF, 8, 2, "x")) != "");
  CHECK(error_of(png(4, 4, 8, 2, std::string(4, '\0'))) != "");  // too few rows
  CHECK(error_of(png(4, 4, 7, 2, std::string(99, '\0'))) != "");
  CHECK(error_of("") != "");
  CHECK(error_of("GIF89a" + std::string(100, 'x')) != "");
  CHECK(error_of("\xff\xd8\xff\xe0" + std::string(100, 'x')) != "");
  CHECK(error_of("RIFF\x10\1\0\0WEBPVP8 " + std::string(100, 'x')) != "");
  CHECK(error_of("\x76\x2f\x31\x01" + std::string(100, 'x')) != "");
}

TEST_CASE("deep EXR files and those of several parts are refused") {
  for (const char flag : {'\x08', '\x10'}) {
    const std::string bytes = std::string("\x76\x2f\x31\x01\x02", 5) + flag + std::string(60, '\0');
    CHECK_THAT(error_of(bytes), ContainsSubstring(flag == '\x08' ? "deep" : "several parts"));
  }
}

TEST_CASE("images of one row, one column and one pixel have all their levels") {
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(1, 37), std::pair(16384, 1), std::pair(5, 3)}) {
    StoredImage image;
    image.width = width, image.height = height, image.channels = 1;
    for (int i = 0; i < width * height; ++i) image.data.push_back(static_cast<std::uint8_t>(37 * i));
    const auto levels = smaller_levels(image, SampleUse::data);
    int w = width, h = height;
    for (const StoredImage& level : levels) {
      w = std::max(1, w / 2), h = std::max(1, h / 2);
      CHECK(level.width == w);
      CHECK(level.height == h);
    }
    CHECK(w * h == 1);
  }
}

TEST_CASE("smaller levels keep the mean of the light, whatever the edges") {
  for (const int edge : {8, 7, 13}) {
    StoredImage image;
    image.width = image.height = edge;
    image.channels = 1;
    for (int i = 0; i < edge * edge; ++i)
      image.data.push_back(static_cast<std::uint8_t>(97 * i * i + 11 * i));
    for (const bool srgb : {false, true}) {
      const auto levels = smaller_levels(image, srgb ? SampleUse::color : SampleUse::data);
      CHECK(mean_of(levels.back(), srgb) == Approx(mean_of(image, srgb)).margin(0.005));
    }
  }
}

TEST_CASE("a texel of each level is the mean light of all pixels below it") {
  for (const auto& [width, height] : {std::pair(128, 64), std::pair(96, 160), std::pair(2, 256)}) {
    StoredImage image;
    image.width = width, image.height = height;
    for (int i = 0; i < width * height; ++i)
      for (const int factor : {7, 31, 97})
        image.data.push_back(static_cast<std::uint8_t>(factor * i * i + i));
    for (std::size_t i = 3; i <= image.data.size(); i += 4)
      image.data.insert(image.data.begin() + static_cast<std::ptrdiff_t>(i), 255);
    const auto light = [](const StoredImage& from, int x, int y, std::size_t channel) {
      const auto at = static_cast<std::size_t>(y * from.width + x) * 4 + channel;
      return double(linear_from_srgb(float(from.data[at]) / 255));
    };
    int edge = 1;
    for (const StoredImage& level : smaller_levels(image, SampleUse::color)) {
      edge *= 2;
      if (level.width * edge != width || level.height * edge != height) break;
      for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x)
          for (const std::size_t channel : {0u, 1u, 2u}) {
            double sum = 0;
            for (int j = 0; j < edge; ++j)
              for (int i = 0; i < edge; ++i) sum += light(image, x * edge + i, y * edge + j, channel);
            const double wanted = 255 * double(srgb_from_linear(float(sum / (edge * edge))));
            const auto at = static_cast<std::size_t>(y * level.width + x) * 4 + channel;
            REQUIRE(level.data[at] == Approx(wanted).margin(0.76));
          }
    }
    CHECK(edge >= 32 / (width == 2 ? 16 : 1));
  }
}

TEST_CASE("what cannot be seen of an image does not colour its smaller levels") {
  StoredImage image;
  image.width = 2, image.height = 1;
  image.data = {200, 100, 50, 255, 0, 255, 0, 0};
  const StoredImage half = half_size(image, SampleUse::color_by_alpha);
  CHECK(half.data == std::vector<std::uint8_t>{200, 100, 50, 128});
}

TEST_CASE("colours whose alpha nothing uses count alike in smaller levels") {
  StoredImage image;
  image.width = 2, image.height = 1;
  image.data = {255, 0, 0, 255, 0, 255, 0, 0};
  const StoredImage half = half_size(image, SampleUse::color);
  CHECK(half.data == std::vector<std::uint8_t>{188, 188, 0, 128});
}

TEST_CASE("an image's own gamma and sixteen bits of colour become what textures take") {
  StoredImage bytes;
  bytes.width = bytes.height = bytes.channels = 1;
  bytes.data = {128};
  bytes.exponent = 1.0f;
  settle_samples(bytes, true);
  CHECK(bytes.data[0] == 188);  // sRGB of 0.5
  StoredImage words = bytes;
  words.sample = StoredImage::Sample::word;
  words.data = {0xFF, 0x7F};
  settle_samples(words, true);
  std::uint16_t bits;
  std::memcpy(&bits, words.data.data(), 2);
  CHECK(float_from_half(bits) == Approx(0.214).epsilon(2e-3));
}
