// Converts between an Image and a file's bytes, with functions for each format. Only image_io.cpp and tests
// use them. Decoders throw std::runtime_error with the reason; image_io.cpp adds the file's name.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/image_io.h"

namespace sundog {

/// 8 or 16 bits per channel, colours in sRGB and tagged so, alpha linear; texts as iTXt chunks.
std::string encode_png(const Image& image, const FileOptions& options = {});
/// Texts (iTXt chunks) of a PNG; empty for other files.
ImageTexts decode_png_texts(std::string_view bytes);
/// 8-bit sRGB without alpha; colours in full resolution.
std::string encode_jpeg(const Image& image, const FileOptions& options = {});
/// Adds Exif tags for sRGB, the density and, by option, an ICC profile to a JPEG of stb_image_write.
std::string with_jpeg_tags(std::string jpeg, const FileOptions& options);

/// Whether the image file's header says that it has alpha.
bool has_alpha(std::string_view bytes);
/// has_alpha() for an EXR file that passes check_exr_header().
bool exr_has_alpha(std::string_view bytes);

/// Radiance RGBE: no alpha or negative values, precision about 1 %.
std::string encode_hdr(const Image& image);
Image decode_hdr(std::string_view file);

/// Three floats per pixel, little-endian, rows bottom-up.
std::string encode_pfm(const Image& image);
Image decode_pfm(std::string_view bytes);

/// Throws for a multi-part or deep EXR file, and for a header that requests more memory than a file of this
/// length can fill. Call before decoding, which allocates that memory.
void check_exr_header(std::string_view bytes);
/// The names of the channels that are an EXR file's picture, with its alpha, which may be missing: R, G, B or
/// Y, else those of the only layer that has these, else the only channel. Throws if there are several or
/// none.
std::vector<std::string> exr_picture_channels(const std::vector<std::string>& names);
/// Encodes any image; throws only IoError.
std::string encode_exr(const Image& image, const AovImages& aovs, const FileOptions& options);
/// `colors`: converts to sRGB primaries by the file's chromaticities and clips colours outside sRGB.
Image decode_exr(std::string_view bytes, bool colors = true);
AovImages decode_exr_aovs(std::string_view bytes);
/// The header's text attributes.
ImageTexts decode_exr_texts(std::string_view bytes);

}  // namespace sundog
