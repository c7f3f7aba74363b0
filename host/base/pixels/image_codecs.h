// Codecs between bytes in memory and an Image, one format each. Only image_io.cpp and tests use them.
// Decoders throw std::runtime_error with the reason; image_io.cpp adds the file's name.
#pragma once
#include <string>
#include <string_view>

#include "base/image_io.h"

namespace sundog {

/// 8 or 16 bits a channel, colours as sRGB and tagged so, alpha as it is; texts as iTXt chunks.
std::string encode_png(const Image& image, const FileOptions& options = {});
/// Texts (iTXt chunks) of a PNG; empty for other files.
ImageTexts decode_png_texts(std::string_view bytes);
/// Likewise with 8 bits, without alpha; colours in full resolution.
std::string encode_jpeg(const Image& image, const FileOptions& options = {});
/// The JPEG of stb_image_write with Exif tags that say sRGB, its density and, by option, a profile.
std::string with_jpeg_tags(std::string jpeg, const FileOptions& options);

/// Whether an image file has alpha, by its header.
bool has_alpha(std::string_view bytes);
/// Likewise for an EXR file that passes check_exr_header().
bool exr_has_alpha(std::string_view bytes);

/// Radiance RGBE: no alpha or negative values, precision about 1 %.
std::string encode_hdr(const Image& image);
Image decode_hdr(std::string_view file);

/// Three floats a pixel, little-endian, rows bottom-up.
std::string encode_pfm(const Image& image);
Image decode_pfm(std::string_view bytes);

/// Throws for a multi-part or deep EXR file, and for a header that requests more memory than a file of this
/// length can use. Call before decoding, which allocates that memory.
void check_exr_header(std::string_view bytes);
/// Throws IoError only: there is nothing it refuses.
std::string encode_exr(const Image& image, const AovImages& aovs, const FileOptions& options);
/// `colors`: red, green and blue become those of sRGB, by the file's chromaticities; what is outside is cut
/// off.
Image decode_exr(std::string_view bytes, bool colors = true);
AovImages decode_exr_aovs(std::string_view bytes);
/// The header's text attributes.
ImageTexts decode_exr_texts(std::string_view bytes);

}  // namespace sundog
