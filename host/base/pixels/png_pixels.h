// Decodes the pixels of the most common PNG files. libspng takes 2.2 to 2.7 times as long, because it
// unfilters byte by byte and inflates with zlib at half of libdeflate's speed.
#pragma once
#include <string_view>

#include "base/pixels/stored_image.h"

namespace sundog {

/// Fills `image.data` from a PNG of 8 bits per sample, not interlaced and without a transparent colour, that
/// has `file_channels` channels: 1 for a grey image, 3 or 4 for `image.channels` 4. Returns false for unusual
/// or broken files, which libspng must decode or refuse.
bool decode_png_pixels(std::string_view bytes, std::size_t file_channels, StoredImage& image);

}  // namespace sundog
