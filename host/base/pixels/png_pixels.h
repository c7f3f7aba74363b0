// The pixels of the most common PNG files, faster than libspng has them: its filters work byte by byte, and
// zlib inflates half as fast as libdeflate.
#pragma once
#include <string_view>

#include "base/pixels/stored_image.h"

namespace sundog {

/// Fills `image.data` from a PNG of 8 bits a sample without interlacing or a transparent colour, whose
/// channels (1 of 1, 3 of 4 or 4 of 4) are `file_channels` and `image.channels`. Returns whether it could:
/// false for whatever is unusual or broken, of which libspng then makes what it makes, an error most often.
bool decode_png_pixels(std::string_view bytes, std::size_t file_channels, StoredImage& image);

}  // namespace sundog
