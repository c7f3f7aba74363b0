// Reading and writing images: by file extension .png and .jpg (8-bit sRGB), .exr, .hdr, .pfm are written; the
// same and 16-bit PNG are read, whatever the file's name.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/image.h"

namespace sundog {

/// How an EXR keeps the colour channels (AOVs are always 32-bit floats).
enum class ExrColor { half, full };

/// Words about an image, by their names: what made it, of what. PNG and EXR keep them.
using ImageTexts = std::vector<std::pair<std::string, std::string>>;

/// Writes `image` (3 or 4 channels, linear) in the format of the extension; the file appears whole or not at
/// all (temporary and rename). `aovs` become further channels of an EXR ("depth.Z", "normal.X"...); other
/// formats refuse them. Throws UsageError for an unknown extension, IoError when the file cannot be written.
void write_image(const Image& image, const std::filesystem::path& path, const AovImages& aovs = {},
                 ExrColor color = ExrColor::half);

/// The bytes that `write_image` writes; `texts` go into a PNG or an EXR.
std::string encode_image(const Image& image, const std::filesystem::path& path, const AovImages& aovs = {},
                         ExrColor color = ExrColor::half, const ImageTexts& texts = {});

/// The extensions that are written, without the dot.
const std::vector<std::string>& image_formats();

/// True where a program would show an alpha channel of coverage as holes.
bool drops_alpha(const std::filesystem::path& path);

/// Whether a file of this name has 8 bits a channel: .png, .jpg, .jpeg.
bool has_eight_bits(const std::filesystem::path& path);

/// Whether a file of this name keeps ImageTexts: .png, .exr.
bool keeps_texts(const std::filesystem::path& path);

/// Throws UsageError for an extension `write_image` would refuse: call it before a long render.
void check_image_path(const std::filesystem::path& path, bool with_aovs);

/// Reads an image as linear RGBA floats (8-bit and 16-bit PNG/JPEG are decoded from sRGB, unless a PNG states
/// another gamma). Throws SceneError on a bad file.
Image read_image(const std::filesystem::path& path);

/// The same, and whether the file itself has alpha: where not, the image's is 1.
struct ImageInFile {
  Image image;
  bool alpha = false;
};
ImageInFile read_image_in_file(const std::filesystem::path& path);

/// The texts of a PNG or an EXR; empty for other formats. Throws SceneError on a bad file.
ImageTexts read_texts(const std::filesystem::path& path);

/// The extra images of an EXR, by name; empty for other formats. Throws SceneError on a bad file.
AovImages read_aovs(const std::filesystem::path& path);

float srgb_from_linear(float linear);
float linear_from_srgb(float srgb);

}  // namespace sundog
