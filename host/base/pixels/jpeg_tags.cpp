// Writes a JPEG's colour space and density to its JFIF header, ICC profile and Exif (CIPA DC-008, 4.6: a TIFF
// header and directories of tags).
#include "base/colors/icc_profile.h"
#include "base/pixels/image_codecs.h"

namespace sundog {
namespace {

std::string little_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 255);
  return text;
}

std::string big_endian_word(std::size_t value) {
  return {static_cast<char>(value >> 8 & 255), static_cast<char>(value & 255)};
}

std::string segment(unsigned char marker, const std::string& content) {
  return std::string("\xff") + static_cast<char>(marker) + big_endian_word(content.size() + 2) + content;
}

enum ExifType : std::uint32_t { short_value = 3, long_value = 4, rational = 5, undefined = 7 };

std::string tag(std::uint32_t name, ExifType type, std::uint32_t count, std::uint32_t value) {
  return little_endian(name, 2) + little_endian(type, 2) + little_endian(count, 4) + little_endian(value, 4);
}

std::string exif(int dpi) {
  constexpr std::uint32_t first = 8, second = first + 2 + 4 * 12 + 4, resolution = second + 2 + 2 * 12 + 4;
  constexpr std::uint32_t version = 0x30333230;  // "0230"
  std::string text("Exif\0\0II*\0", 10);
  text += little_endian(first, 4) + little_endian(4, 2);
  text += tag(0x011a, rational, 1, resolution) + tag(0x011b, rational, 1, resolution);
  text += tag(0x0128, short_value, 1, 2);  // inches
  text += tag(0x8769, long_value, 1, second) + little_endian(0, 4) + little_endian(2, 2);
  text += tag(0x9000, undefined, 4, version) + tag(0xa001, short_value, 1, 1);  // sRGB
  return text + little_endian(0, 4) + little_endian(static_cast<std::uint32_t>(dpi), 4) + little_endian(1, 4);
}

}  // namespace

std::string with_jpeg_tags(std::string jpeg, const FileOptions& options) {
  constexpr std::size_t units = 13, header_end = 20;
  const std::string density = big_endian_word(static_cast<std::size_t>(options.dpi));
  jpeg.replace(units, 5, "\x01" + density + density);
  std::string segments = segment(0xe1, exif(options.dpi));
  // The profile in one piece, numbered 1 of 1 (ICC.1:2022, annex B.4).
  if (options.icc) segments += segment(0xe2, std::string("ICC_PROFILE\0\1\1", 14) + srgb_icc_profile());
  return jpeg.insert(header_end, segments);
}

}  // namespace sundog
