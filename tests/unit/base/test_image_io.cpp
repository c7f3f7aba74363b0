// Image files: what is written is read again, within what each format can hold; bad files give errors.
#include <zlib.h>

#include <base/error.h>
#include <base/file.h>
#include <base/image_io.h>
#include <base/pixels/image_codecs.h>
#include <base/pixels/stored_image.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "assets.h"
#include "catch.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

/// Every pixel different, from 0 to a bit more than 1.
Image ramp(int width, int height, int channels) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    image.data[i] =
        1.1f * static_cast<float>(i * 7919 % image.data.size()) / static_cast<float>(image.data.size());
  return image;
}

float written_and_read(const std::string& name, float value) {
  const TemporaryFolder folder;
  Image image(1, 1, 3);
  image.data = {value, value, value};
  write_image(image, folder / name);
  return read_image(folder / name).data[0];
}

std::string error_of(const std::filesystem::path& path) {
  try {
    read_image(path);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("sRGB encoding and decoding are inverse and meet at the published points") {
  CHECK(srgb_from_linear(0) == 0);
  CHECK(srgb_from_linear(1) == Approx(1));
  CHECK(srgb_from_linear(0.5f) == Approx(0.735357).epsilon(1e-5));
  CHECK(linear_from_srgb(0.04045f) == Approx(0.0031308).epsilon(1e-4));
  for (int i = 0; i <= 1000; ++i) {
    const float x = static_cast<float>(i) / 1000;
    CHECK(linear_from_srgb(srgb_from_linear(x)) == Approx(x).margin(1e-6));
  }
}

TEST_CASE("a PNG holds every pixel to half a step of its 8 bits") {
  const TemporaryFolder folder;
  const int channels = GENERATE(3, 4);
  Image image = ramp(37, 23, channels);
  write_image(image, folder / "a.png");
  const Image read = read_image(folder / "a.png");
  REQUIRE(read.width == 37);
  REQUIRE(read.height == 23);
  REQUIRE(read.channels == 4);
  for (int y = 0; y < 23; ++y)
    for (int x = 0; x < 37; ++x)
      for (int c = 0; c < 4; ++c) {
        const float found = read.pixel(x, y)[c];
        const float wanted = c < channels ? std::min(image.pixel(x, y)[c], 1.0f) : 1.0f;
        if (c == 3)
          CHECK(std::abs(found - wanted) <= 0.5f / 255 + 1e-6f);
        else
          CHECK(std::abs(srgb_from_linear(found) - srgb_from_linear(wanted)) <= 0.5f / 255 + 1e-6f);
      }
}

TEST_CASE("a PNG of 16 bits holds every pixel to half a step of them") {
  const TemporaryFolder folder;
  const Image image = ramp(37, 23, 4);
  write_image(image, folder / "a.png", {}, {.bits = 16});
  const Image read = read_image(folder / "a.png");
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const bool alpha = i % 4 == 3;
    const auto shown = [&](float v) { return alpha ? v : srgb_from_linear(v); };
    REQUIRE(std::abs(shown(read.data[i]) - shown(std::min(image.data[i], 1.0f))) <= 0.51f / 65535);
  }
}

TEST_CASE("PNG, JPEG and EXR state their colours and their density") {
  const TemporaryFolder folder;
  const auto written = [&](const char* name, const FileOptions& options) {
    write_image(ramp(5, 4, 3), folder / name, {}, options);
    return read_file(folder / name);
  };
  const std::string png = written("a.png", {.dpi = 300});
  const auto chunk = [&](const char* name, std::size_t length) {
    return png.substr(std::min(png.find(name), png.find("IDAT")) + 4, length);
  };
  CHECK(chunk("sRGB", 1) == std::string(1, '\0'));
  CHECK(chunk("gAMA", 4) == std::string("\0\0\xb1\x8f", 4));
  CHECK(chunk("cHRM", 4) == std::string("\0\0\x7a\x26", 4));  // 0.3127, x of white
  CHECK(chunk("pHYs", 9) == std::string("\0\0\x2e\x23\0\0\x2e\x23\1", 9));
  const std::string jpeg = written("a.jpg", {.dpi = 300});
  CHECK(jpeg.substr(6, 12) == std::string("JFIF\0\1\1\1\1\x2c\1\x2c", 12));
  CHECK(jpeg.find("Exif") == 24);
  CHECK(jpeg.find(std::string("\1\xa0\3\0\1\0\0\0\1\0", 10)) != std::string::npos);  // colour space 1
  const std::string exr = written("a.exr", {.dpi = 300, .texts = {{"capDate", "2026:11:26 12:00:00"}}});
  CHECK(exr.find(std::string("xDensity\0float\0\4\0\0\0\0\0\x96\x43", 23)) != std::string::npos);
  CHECK(exr.find(std::string("utcOffset\0float\0\4\0\0\0\0\0\0\0", 24)) != std::string::npos);
  CHECK(exr.find("chromaticities") != std::string::npos);
}

TEST_CASE("an EXR in ACEScg says so, and is read as what was written") {
  const TemporaryFolder folder;
  Image image = ramp(9, 7, 4);
  image.data[0] = 1, image.data[1] = image.data[2] = 0;
  write_image(image, folder / "srgb.exr", {{"albedo", image}}, {.color = ExrColor::full});
  write_image(image, folder / "aces.exr", {{"albedo", image}},
              {.color = ExrColor::full, .space = ExrSpace::acescg});
  const Image read = read_image(folder / "aces.exr");
  for (std::size_t i = 0; i < image.data.size(); ++i)
    REQUIRE(read.data[i] == Approx(image.data[i]).margin(1e-5));
  // Linear sRGB's red in ACEScg, by OpenColorIO.
  const Image albedo = read_aovs(folder / "aces.exr").at("albedo");
  CHECK(albedo.data[0] == Approx(0.613097).margin(2e-4));
  CHECK(albedo.data[1] == Approx(0.070194).margin(2e-4));
  CHECK(albedo.data[2] == Approx(0.020616).margin(2e-4));
  // sRGB's numbers labelled ACEScg: the red is outside of sRGB, and cut off.
  std::string exr = read_file(folder / "srgb.exr");
  const std::string aces = read_file(folder / "aces.exr"), name = "chromaticities";
  const std::size_t at = exr.find(name), length = name.size() + 1 + name.size() + 1 + 4 + 32;
  exr.replace(at, length, aces.substr(aces.find(name), length));
  const Image wide = read_image(folder.write("wide.exr", exr));
  CHECK(wide.data[0] == Approx(1.70505).margin(2e-3));
  CHECK(wide.data[1] == 0);
  CHECK(decode_stored(exr, false).data[0] == decode_stored(read_file(folder / "srgb.exr"), false).data[0]);
}

TEST_CASE(
    "an EXR whose picture is its only layer or channel is read; the error names the channels of others") {
  using Names = std::vector<std::string>;
  CHECK(exr_picture_channels({"A", "B", "G", "R", "depth.Z"}) == Names{"R", "G", "B", "A"});
  CHECK(exr_picture_channels({"Y", "beauty.R"}) == Names{"Y", "A"});
  CHECK(exr_picture_channels({"View.Beauty.B", "View.Beauty.G", "View.Beauty.R", "Z", "normal.X"}) ==
        Names{"View.Beauty.R", "View.Beauty.G", "View.Beauty.B", "View.Beauty.A"});
  CHECK(exr_picture_channels({"Z"}) == Names{"Z", "A"});
  CHECK_THROWS_WITH(exr_picture_channels({"a.R", "b.R"}), ContainsSubstring("a.R, b.R"));
  const TemporaryFolder folder;
  const Image other = ramp(3, 2, 3), layer = ramp(3, 2, 4);
  write_image(other, folder / "a.exr", {{"albedo", layer}});
  std::string exr = read_file(folder / "a.exr");
  for (const auto& [name, number] : {std::pair("B", "1"), std::pair("G", "2"), std::pair("R", "3")})
    exr.replace(exr.find(name + std::string("\0\1\0\0\0", 5), exr.find("chlist")), 1, number);
  CHECK(read_image(folder.write("b.exr", exr)).data == layer.data);
}

TEST_CASE("row 0 is the top of every format") {
  const TemporaryFolder folder;
  const std::string name = GENERATE("a.png", "a.exr", "a.hdr", "a.pfm");
  Image image(9, 2, 3);
  for (int x = 0; x < 9; ++x) image.pixel(x, 0)[0] = 1;
  write_image(image, folder / name);
  const Image read = read_image(folder / name);
  for (int x = 0; x < 9; ++x) {
    CHECK(read.pixel(x, 0)[0] == 1);
    CHECK(read.pixel(x, 1)[0] == 0);
  }
}

TEST_CASE("PFM and 32-bit EXR keep every bit, infinities and NaN too") {
  const TemporaryFolder folder;
  const std::string name = GENERATE("a.exr", "a.pfm");
  Image image = ramp(31, 17, 3);
  image.data[0] = std::numeric_limits<float>::infinity();
  image.data[1] = -3e38f;
  image.data[2] = std::numeric_limits<float>::quiet_NaN();
  image.data[3] = 1e-40f;
  write_image(image, folder / name, {}, {.color = ExrColor::full});
  const Image read = read_image(folder / name);
  for (int y = 0; y < 17; ++y)
    for (int x = 0; x < 31; ++x) {
      CHECK(std::memcmp(read.pixel(x, y), image.pixel(x, y), 12) == 0);
      CHECK(read.pixel(x, y)[3] == 1);
    }
}

TEST_CASE("an EXR's half colours are the nearest halves, and overflow to the greatest one") {
  CHECK(written_and_read("a.exr", 0.1f) == Approx(0.1).epsilon(1.0 / 2048));
  CHECK(written_and_read("a.exr", 2049) == 2048);
  CHECK(written_and_read("a.exr", 1e6f) == 65504);
  CHECK(written_and_read("a.exr", -1e6f) == -65504);
}

TEST_CASE("HDR keeps bright values to one percent and drops what it cannot hold") {
  CHECK(written_and_read("a.hdr", 12345) == Approx(12345).epsilon(0.01));
  CHECK(written_and_read("a.hdr", -1) == 0);
  CHECK(written_and_read("a.hdr", std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(written_and_read("a.hdr", std::numeric_limits<float>::infinity()) > 1e37f);
}

TEST_CASE("a PNG takes what is not in its range") {
  CHECK(written_and_read("a.png", -1) == 0);
  CHECK(written_and_read("a.png", std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(written_and_read("a.png", std::numeric_limits<float>::infinity()) == 1);
}

TEST_CASE("AOVs come back from an EXR to the bit, beside the colour") {
  const TemporaryFolder folder;
  AovImages aovs;
  aovs["depth"] = ramp(13, 11, 1);
  aovs["normal"] = ramp(13, 11, 3);
  aovs["albedo"] = ramp(13, 11, 3);
  aovs["object"] = ramp(13, 11, 1);
  aovs["depth"].data[0] = std::numeric_limits<float>::infinity();
  const Image image = ramp(13, 11, 4);
  write_image(image, folder / "a.exr", aovs, {.color = ExrColor::full});
  CHECK(read_image(folder / "a.exr").data == image.data);
  const AovImages read = read_aovs(folder / "a.exr");
  REQUIRE(read.size() == 4);
  for (const auto& [name, aov] : aovs) {
    CAPTURE(name);
    CHECK(read.at(name).channels == aov.channels);
    CHECK(read.at(name).data == aov.data);
  }
}

TEST_CASE("threads that share an EXR's work write its bytes") {
  const Image image = ramp(31, 150, 4);
  const AovImages aovs = {{"normal", ramp(31, 150, 3)}, {"albedo", ramp(31, 150, 3)}};
  const auto bytes = [&](unsigned threads) {
    share_exr_work(threads);
    const Region part{5, 40, 100, 300};
    return encode_image(image, "a.exr", aovs, {.space = ExrSpace::acescg, .region = part}) +
           encode_image(image, "a.exr", aovs, {.color = ExrColor::full});
  };
  const std::string alone = bytes(0);
  CHECK(bytes(3) == alone);
  CHECK(bytes(0) == alone);
}

TEST_CASE("only EXR takes AOVs, and only known extensions are written") {
  CHECK_NOTHROW(check_image_path("a.exr", true));
  CHECK_NOTHROW(check_image_path("A.PNG", false));
  CHECK_THROWS_AS(check_image_path("a.png", true), UsageError);
  CHECK_NOTHROW(check_image_path("a.jpg", false));
  CHECK_THROWS_AS(check_image_path("a.jpg", true), UsageError);
  CHECK_THROWS_AS(check_image_path("png", false), UsageError);
  CHECK_THROWS_WITH(
      check_image_path("a.gif", false),
      "a.gif: wanted an image file name that ends in .png, .jpg, .exr, .hdr or .pfm, found .gif");
}

TEST_CASE("JPEG and HDR hold so many pixels, others what a frame has") {
  for (const char* name : {"a.jpg", "a.JPEG"}) CHECK_THROWS_AS(check_image_size(name, 65536, 1), UsageError);
  for (const char* name : {"a.jpg", "a.hdr"})
    CHECK_THROWS_AS(check_image_size(name, 30000, 30000), UsageError);
  for (const char* name : {"a.png", "a.exr", "a.pfm"}) CHECK_NOTHROW(check_image_size(name, 65536, 65536));
  for (const char* name : {"a.jpg", "a.hdr"}) CHECK_NOTHROW(check_image_size(name, 16384, 16384));
}

TEST_CASE("an image is recognised by its content, not its name") {
  const TemporaryFolder folder;
  write_image(ramp(3, 3, 3), folder / "a.exr");
  std::filesystem::rename(folder / "a.exr", folder / "a.png");
  CHECK(read_image(folder / "a.png").width == 3);
}

TEST_CASE("a big-endian and a grey PFM are read") {
  const TemporaryFolder folder;
  const std::string text = "Pf 2 1 1.0\n" + std::string("\x3f\x80\x00\x00\x40\x00\x00\x00", 8);
  const Image image = read_image(folder.write("a.pfm", text));
  CHECK(image.pixel(0, 0)[2] == 1);
  CHECK(image.pixel(1, 0)[0] == 2);
}

TEST_CASE("bad image files give one line that names the file") {
  const TemporaryFolder folder;
  const std::string name = GENERATE("a.png", "a.exr", "a.hdr", "a.pfm");
  write_image(ramp(40, 40, 3), folder / name);
  const std::string whole = read_file(folder / name);
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{3}, std::size_t{12}, whole.size() / 2, whole.size() - 1}) {
    CAPTURE(name, length);
    const auto cut = folder.write("cut", whole.substr(0, length));
    const std::string error = error_of(cut);
    if (name == "a.png" && length == whole.size() - 1)
      continue;  // all but a byte of the end mark: no pixel is lost
    CHECK(error.starts_with(cut.string() + ": "));
    CHECK(error.find('\n') == std::string::npos);
  }
}

TEST_CASE("a file that says it has far more pixels than bytes is refused at once") {
  const TemporaryFolder folder;
  CHECK(error_of(folder.write("a.pfm", "PF\n2000000000 2000000000\n-1\n1234")).find("cut short") !=
        std::string::npos);
  CHECK(error_of(folder.write("b.pfm", "PF\n-3 4\n-1\n1234")).find("empty") != std::string::npos);
  CHECK(error_of(folder.write("c.pfm", "PF\nthree 4\n-1\n1234")).find("'three'") != std::string::npos);
  write_image(ramp(4, 4, 3), folder / "a.exr");
  std::string exr = read_file(folder / "a.exr");
  for (const std::string window : {"dataWindow", "displayWindow"}) {
    const std::int32_t last_x = 9'999'999;  // name, 0, "box2i", 0, size, then x0 y0 x1 y1
    std::memcpy(exr.data() + exr.find(window) + window.size() + 1 + 6 + 4 + 8, &last_x, 4);
  }
  CHECK_THAT(error_of(folder.write("b.exr", exr)), ContainsSubstring("10000000x4 pixels"));
}

TEST_CASE("an EXR is its display window: 0 beyond its data, and data beyond it cut off") {
  const TemporaryFolder folder;
  const Image data = ramp(4, 4, 3);
  write_image(data, folder / "a.exr", {}, {.color = ExrColor::full});
  std::string exr = read_file(folder / "a.exr");
  const std::int32_t shown[] = {-1, -2, 2, 5};  // x0 y0 x1 y1 behind the name, 0, "box2i", 0, size
  const std::string window = "displayWindow";
  std::memcpy(exr.data() + exr.find(window) + window.size() + 1 + 6 + 4, shown, sizeof shown);
  const Image image = read_image(folder.write("b.exr", exr));
  REQUIRE(image.width == 4);
  REQUIRE(image.height == 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 4; ++x) {
      const bool inside = x >= 1 && y >= 2 && y < 6;
      for (int c = 0; c < 3; ++c) CHECK(image.pixel(x, y)[c] == (inside ? data.pixel(x - 1, y - 2)[c] : 0));
      CHECK(image.pixel(x, y)[3] == 1);  // of a file without alpha
    }
  const std::int32_t huge[] = {0, 0, 16383, 16383};
  std::memcpy(exr.data() + exr.find(window) + window.size() + 1 + 6 + 4, huge, sizeof huge);
  CHECK_THAT(error_of(folder.write("c.exr", exr)), ContainsSubstring("display window of 16384x16384 pixels"));
}

TEST_CASE("an HDR file of the older form is read, and one that is no picture is refused") {
  const TemporaryFolder folder;
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  const std::string pixels("\x80\x40\x20\x81\x01\x01\x01\x03", 8);  // one pixel, and the same three times
  const Image image = read_image(folder.write("a.hdr", header + "-Y 1 +X 4\n" + pixels));
  for (int x = 0; x < 4; ++x) {
    CHECK(image.pixel(x, 0)[0] == 1);
    CHECK(image.pixel(x, 0)[1] == 0.5f);
    CHECK(image.pixel(x, 0)[2] == 0.25f);
  }
  CHECK(error_of(folder.write("b.hdr", header + "-Y 1 +X 3\n" + pixels)).find("bad run length") !=
        std::string::npos);
  CHECK(error_of(folder.write("c.hdr", header + "+Y 1 +X 4\n" + pixels)).find("'+Y 1 +X 4'") !=
        std::string::npos);
  CHECK(error_of(folder.write("d.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 4\n" + pixels))
            .find("xyze") != std::string::npos);
}

TEST_CASE("a missing image and a folder are SceneErrors") {
  const TemporaryFolder folder;
  CHECK(error_of(folder / "none.png") ==
        (folder / "none.png").string() + ": cannot be read: No such file or directory");
  CHECK(error_of(folder.path()) == folder.path().string() + ": is a directory");
}

TEST_CASE("a PNG's gAMA chunk says how it is decoded, unless an sRGB chunk does") {
  const TemporaryFolder folder;
  Image image(1, 1, 3);
  image.data = {linear_from_srgb(100.0f / 255), 0, 0};
  write_image(image, folder / "a.png");
  std::string png = read_file(folder / "a.png");
  png.erase(33, png.find("IDAT") - 4 - 33);
  const auto with_chunk =
      [&](const std::string& chunk) {  // after the 8-byte signature and the 25-byte header chunk
        const auto sum = static_cast<std::uint32_t>(::crc32(
            0, reinterpret_cast<const Bytef*>(chunk.data()) + 4, static_cast<uInt>(chunk.size() - 4)));
        std::string last;
        for (int shift = 24; shift >= 0; shift -= 8) last += static_cast<char>(sum >> shift);
        folder.write("b.png", png.substr(0, 33) + chunk + last + png.substr(33));
        return read_image(folder / "b.png").data[0];
      };
  CHECK(with_chunk(std::string("\0\0\0\4gAMA\0\1\x86\xa0", 12)) == Approx(100.0 / 255));               // 1
  CHECK(with_chunk(std::string("\0\0\0\4gAMA\0\0\xc3\x50", 12)) == Approx(std::pow(100.0 / 255, 2)));  // 0.5
  CHECK(with_chunk(std::string("\0\0\0\4gAMA\0\0\xb1\x8f", 12)) == image.data[0]);  // 0.45455, meant as sRGB
  CHECK(with_chunk(std::string("\0\0\0\1sRGB\0", 9)) == image.data[0]);
}

TEST_CASE("a picture that POV-Ray wrote with linear samples is read as such") {
  const auto assets = assets_directory();
  if (assets.empty()) return;
  const Image image = read_image(assets / "reference/spd/balls.povray.513.linear16.png");
  REQUIRE(image.width == 513);
  const float* floor = image.pixel(0, 0);  // its colour is (1, 0.75, 0.33), dimmed by the light's angle
  CHECK(floor[0] > 0.1f);
  CHECK(floor[1] / floor[0] == Approx(0.75).epsilon(1e-4));
  CHECK(floor[2] / floor[0] == Approx(0.33).epsilon(1e-4));
}
