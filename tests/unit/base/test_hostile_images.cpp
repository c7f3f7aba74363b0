// Damaged PNG, JPEG, WebP, BMP, TGA, EXR and HDR files: each prefix, and each byte changed. Each is an image
// within the limits or an error; none crashes or takes long.
#include <base/limits.h>
#include <base/pixels/image_codecs.h>
#include <base/pixels/stored_image.h>

#include <string>

#include "catch.h"

using namespace sundog;

namespace {

/// 6x5 pixels, lossless and lossy, by libwebp's encoder.
const char* const webp_lossless =
    "5249464666000000574542505650384c590000002f05000100cd6444ff631311fd0f28adb51d3381244ae29744c9"
    "008e094c208926904451fc1d42944c204a26308d4020119c7f80480402894914a30f1801372138368cd2074ee421"
    "51fdd10c1086df18cb82e2c90d042e820400";
const char* const webp_lossy =
    "52494646640000005745425056503820580000001002009d012a060005000280422590027430494168d65498b000"
    "ce39531f1bddd845e5aebebb73e6f2a5770d86cd480229b7f76b9ff357481a9d977c773f31c3e41bff83933f8378"
    "924556bff000788ab203822ac0000000";

std::string from_hex(const std::string& digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return bytes;
}

Image small_image() {
  Image image(9, 7, 4);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    image.data[i] = i % 4 == 3 ? 1.0f : static_cast<float>(i * i % 97) / 97;
  return image;
}

/// Decodes it, whatever comes of it; whether it is an image.
bool decodes(const std::string& bytes) {
  try {
    const StoredImage image = decode_stored(bytes);
    CHECK(is_frame_size(image.width, image.height));
    CHECK(image.data.size() == image.pixel_count() * image.pixel_bytes());
    return true;
  } catch (const std::exception& error) {
    CHECK(std::string(error.what()) != "");
    return false;
  }
}

/// `rows_may_lack`: what is decoded row by row may have its last ones missing.
void damage(const std::string& good, bool rows_may_lack) {
  REQUIRE(decodes(good));
  for (std::size_t length = 0; length < good.size(); ++length) {
    const bool some = decodes(good.substr(0, length));
    if (!rows_may_lack && length < good.size() / 2) CHECK_FALSE(some);
  }
  for (std::size_t at = 0; at < good.size(); ++at)
    for (const char change : {'\x01', '\x80', '\xff'}) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ change);
      decodes(bad);
    }
}

}  // namespace

TEST_CASE("damaged PNG files are images or errors") {
  StoredImage image;
  image.width = 9, image.height = 7;
  for (std::size_t i = 0; i < image.pixel_count() * 4; ++i)
    image.data.push_back(static_cast<std::uint8_t>(i * i % 97));
  damage(encode_png(image), false);
}
TEST_CASE("damaged JPEG files are images or errors") { damage(encode_jpeg(small_image()), false); }
TEST_CASE("damaged WebP files are images or errors") {
  damage(from_hex(webp_lossless), false);
  damage(from_hex(webp_lossy), false);
}
TEST_CASE("damaged EXR files are images or errors") { damage(encode_exr(small_image(), {}, {}), true); }
TEST_CASE("damaged HDR files are images or errors") { damage(encode_hdr(small_image()), false); }

namespace {

/// Why an EXR is refused whose header begins with this attribute.
std::string exr_refusal(const std::string& attribute) {
  std::string bytes = encode_exr(small_image(), {}, {});
  bytes.insert(8, attribute);
  try {
    check_exr_header(bytes);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

std::string number(std::uint64_t value, int bytes = 4) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 0xff);
  return text;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + number(value.size()) + value;
}

}  // namespace

TEST_CASE("an EXR header that asks for more memory than the file can use is refused, with the figure") {
  const std::string two_gib =
      std::string("\x76\x2f\x31\x01\x02\0\0\0a\0string\0", 17) + number(0x7fffffff) + "x";
  CHECK_THROWS_WITH(decode_exr(two_gib), ContainsSubstring("says 2147483647 bytes of \"a\", and has 1"));
  CHECK_THROWS_WITH(decode_stored(two_gib), ContainsSubstring("2147483647"));
  CHECK(exr_refusal(attribute("owner", "string", "me")).empty());
  CHECK(exr_refusal(attribute("preview", "preview", number(2) + number(1) + number(0, 8))).empty());
  CHECK_THAT(exr_refusal(attribute("preview", "preview", number(30000) + number(17000) + number(0, 8))),
             ContainsSubstring("a preview of 30000x17000 pixels in 8 bytes"));
  CHECK_THAT(exr_refusal(attribute("v", "stringvector", number(0x7fffffff) + "x")),
             ContainsSubstring("cut short"));
  CHECK_THAT(exr_refusal(attribute("m", "idmanifest", number(1ull << 40, 8) + "x")),
             ContainsSubstring("an idmanifest of 1099511627776 bytes in 1"));
  CHECK_THAT(exr_refusal(attribute("tiles", "tiledesc", number(1 << 20) + number(1 << 20) + "x")),
             ContainsSubstring("tiles of 1099511627776 pixels"));
  std::string channels;
  for (int i = 0; i < 2000; ++i)
    channels += "c" + std::to_string(i) + '\0' + number(2) + std::string(12, '\0');
  channels += '\0';
  std::string wide = std::string("\x76\x2f\x31\x01\x02\0\0\0", 8);
  wide += attribute("channels", "chlist", channels) + attribute("compression", "compression", "\x09");
  wide += attribute("dataWindow", "box2i", number(0) + number(0) + number(65535) + number(0)) + '\0';
  CHECK_THROWS_WITH(check_exr_header(wide), ContainsSubstring("MiB for each 256 lines"));
}

TEST_CASE("a JPEG or WebP header that lies about the size is an error") {
  std::string jpeg = encode_jpeg(small_image());
  const std::size_t frame = jpeg.find("\xff\xc0");
  REQUIRE(frame != std::string::npos);
  for (std::size_t i = 5; i < 9; ++i) jpeg[frame + i] = '\xff';  // 65535 x 65535
  CHECK_FALSE(decodes(jpeg));
  std::string webp = from_hex(webp_lossless);
  for (std::size_t i = 21; i < 24; ++i) webp[i] = '\xff';  // 16384 x 16384
  CHECK_FALSE(decodes(webp));
}

TEST_CASE("BMP and TGA files are read, the first row above, and damaged ones are images or errors") {
  // 2x2 pixels: red, green; blue, white. A BMP row of 24 bits ends at a multiple of four bytes.
  const std::string bmp = from_hex(
      "424d46000000000000003600000028000000020000000200000001001800000000001000000000000000000000000000"
      "000000000000ff0000ffffff00000000ff00ff000000");
  // These rows from below; then runs from above with alpha: two red pixels, green, blue.
  const std::string tga = from_hex(
      "0000020000000000000000000200020018"
      "00"
      "ff0000ffffff0000ff00ff00");
  const std::string runs = from_hex(
      "00000a0000000000000000000200020020"
      "28"
      "810000ff80"
      "0100ff00ffff0000ff");
  const std::vector<std::uint8_t> colors{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
  CHECK(decode_stored(bmp).data == colors);
  CHECK(decode_stored(tga).data == colors);
  CHECK(decode_stored(runs).data ==
        std::vector<std::uint8_t>{255, 0, 0, 128, 255, 0, 0, 128, 0, 255, 0, 255, 0, 0, 255, 255});
  CHECK_FALSE(has_alpha(bmp));
  CHECK_FALSE(has_alpha(tga));
  CHECK(has_alpha(runs));
  const std::string grey_with_alpha = from_hex("000003000000000000000000010001001028ff80");
  CHECK(decode_stored(grey_with_alpha).data == std::vector<std::uint8_t>{255, 255, 255, 128});
  CHECK(has_alpha(grey_with_alpha));
  CHECK_FALSE(has_alpha("any other file"));
  CHECK_THROWS_WITH(decode_stored(tga.substr(0, tga.size() - 3)), "the BMP or TGA image is cut short");
  for (const std::string& good : {bmp, tga, runs}) damage(good, true);
}
