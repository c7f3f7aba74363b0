// Detects alpha in image files by their headers (PNG: ISO 15948, chunks IHDR and tRNS).
#include <webp/decode.h>

#include "base/pixels/image_codecs.h"
#include "base/pixels/stored_image.h"

namespace sundog {
namespace {

bool png_has_alpha(std::string_view bytes) {
  constexpr std::size_t color_type = 25;
  constexpr int with_alpha = 4;
  if (bytes.size() <= color_type) return false;
  return (bytes[color_type] & with_alpha) != 0 || bytes.find("tRNS") < bytes.find("IDAT");
}

}  // namespace

bool has_alpha(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return png_has_alpha(bytes);
  if (bytes.starts_with("\x76\x2f\x31\x01")) return exr_has_alpha(bytes);
  WebPBitstreamFeatures features{};
  if (!bytes.starts_with("RIFF")) {
    const int channels = channels_of_bmp_or_tga(bytes);
    return channels == 2 || channels == 4;
  }
  return WebPGetFeatures(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), &features) ==
             VP8_STATUS_OK &&
         features.has_alpha != 0;
}

}  // namespace sundog
