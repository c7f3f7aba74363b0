// The ICC profile of sRGB, read as its specification says (ICC.1:2022, clause 7), and its place in files.
#include <base/colors/icc_profile.h>
#include <base/file.h>
#include <base/image_io.h>
#include <zlib.h>

#include <cmath>
#include <map>

#include "catch.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

double fixed_at(const std::string& bytes, std::size_t at) {
  return static_cast<std::int32_t>(number_at(bytes, at)) / 65536.0;
}

std::map<std::string, std::string> tags_of(const std::string& profile) {
  std::map<std::string, std::string> tags;
  for (std::size_t i = 0, entry = 132; i < number_at(profile, 128); ++i, entry += 12) {
    const std::size_t begin = number_at(profile, entry + 4), size = number_at(profile, entry + 8);
    CHECK(begin % 4 == 0);
    REQUIRE(begin + size <= profile.size());
    tags[profile.substr(entry, 4)] = profile.substr(begin, size);
  }
  return tags;
}

/// The profile of a PNG's iCCP chunk.
std::string profile_in_png(const std::string& png) {
  const std::size_t chunk = png.find("iCCP");
  REQUIRE(chunk < png.find("IDAT"));
  const std::size_t packed = png.find('\0', chunk + 4) + 2;
  std::string profile(4096, '\0');
  uLongf size = profile.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(profile.data()), &size,
                     reinterpret_cast<const Bytef*>(png.data() + packed), png.size() - packed) == Z_OK);
  profile.resize(size);
  return profile;
}

}  // namespace

TEST_CASE("the ICC profile has the primaries of sRGB under D50 and its curve") {
  const std::string profile = srgb_icc_profile();
  CHECK(number_at(profile, 0) == profile.size());
  CHECK(profile.substr(12, 12) == "mntrRGB XYZ ");
  CHECK(profile.substr(36, 4) == "acsp");
  const auto tags = tags_of(profile);
  for (const char* name : {"desc", "cprt", "wtpt", "chad", "gTRC", "bTRC"}) CHECK(tags.contains(name));
  // As in Elle Stone's profile of sRGB, which is exact to the last step.
  const std::map<std::string, std::array<double, 3>> published = {
      {"wtpt", {0.9642, 1, 0.8249}},
      {"rXYZ", {0.43603516, 0.22248840, 0.01391602}},
      {"gXYZ", {0.38511658, 0.71690369, 0.09706116}},
      {"bXYZ", {0.14305115, 0.06060791, 0.71391296}}};
  for (const auto& [name, color] : published)
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(fixed_at(tags.at(name), 8 + 4 * k) == Approx(color[k]).margin(3.2e-5));
  const std::string& curve = tags.at("rTRC");
  CHECK(curve.substr(0, 12) == std::string("para\0\0\0\0\0\3\0\0", 12));
  const auto value = [&](std::size_t i) { return fixed_at(curve, 12 + 4 * i); };
  for (double x = 0; x <= 1; x += 1 / 256.0) {
    const double linear = x >= value(4) ? std::pow(value(1) * x + value(2), value(0)) : value(3) * x;
    CHECK(linear == Approx(linear_from_srgb(static_cast<float>(x))).margin(5e-5));
  }
}

TEST_CASE("a PNG and a JPEG have the ICC profile where that is asked for, and the same pixels") {
  const TemporaryFolder folder;
  Image image(3, 2, 3);
  image.data.assign(image.data.size(), 0.3f);
  const auto written = [&](const char* name, bool icc) {
    write_image(image, folder / name, {}, {.icc = icc});
    return read_file(folder / name);
  };
  const std::string png = written("a.png", true), jpeg = written("a.jpg", true);
  CHECK(profile_in_png(png) == srgb_icc_profile());
  CHECK(png.find(std::string("\0\0\0\1sRGB", 8)) == std::string::npos);
  const std::string head("ICC_PROFILE\0\1\1", 14);
  CHECK(jpeg.find(head + srgb_icc_profile()) != std::string::npos);
  for (const char* name : {"a.png", "a.jpg"}) {
    const Image with = read_image(folder / name);
    const std::string plain = written(name, false);
    CHECK(plain.find("iCCP") == std::string::npos);
    CHECK(plain.find(head) == std::string::npos);
    CHECK(read_image(folder / name).data == with.data);
  }
}
