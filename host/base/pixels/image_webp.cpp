// Decodes WebP with libwebp.
#include <webp/decode.h>

#include <limits>
#include <stdexcept>

#include "base/memory.h"
#include "base/pixels/stored_image.h"

namespace sundog {

StoredImage decode_webp(std::string_view bytes) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPBitstreamFeatures features{};
  if (WebPGetFeatures(data, bytes.size(), &features) != VP8_STATUS_OK)
    throw std::runtime_error("wanted an image, found a bad WebP file");
  if (features.has_animation) throw std::runtime_error("an animated WebP file; wanted one image");
  // A lossless file of a single colour takes 0 bits per pixel, so the size of the file sets no limit.
  check_image_size(features.width, features.height, 4, bytes.size(),
                   std::numeric_limits<std::int64_t>::max());
  StoredImage stored;
  stored.width = features.width;
  stored.height = features.height;
  fill_large(stored.data, stored.pixel_count() * 4);
  if (!WebPDecodeRGBAInto(data, bytes.size(), stored.data.data(), stored.data.size(), 4 * stored.width))
    throw std::runtime_error("the WebP data is bad or cut short");
  return stored;
}

}  // namespace sundog
