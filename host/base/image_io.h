// Reads and writes image files. The extension selects the written format: .png and .jpg (8-bit sRGB), .exr,
// .hdr, .pfm; the content decides when reading, which also takes 16-bit PNG.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/image.h"
#include "base/pixels/shot.h"
#include "base/tone_map.h"

namespace sundog {

/// Precision of an EXR's colour channels (AOVs are always 32-bit floats).
enum class ExrColor { half, full };

/// Named texts about an image, such as the program and scene that made it. Kept by PNG and EXR.
using ImageTexts = std::vector<std::pair<std::string, std::string>>;

/// The space of an EXR's colours.
enum class ExrSpace { srgb, acescg };

/// How a file stores its pixels, and its metadata. Formats ignore options that they cannot store.
struct FileOptions {
  ExrColor color = ExrColor::half;
  ExrSpace space = ExrSpace::srgb;
  int bits = 8;                       // of a PNG's channels: 8 or 16
  int dpi = 72;                       // pixels an inch, for printers: in PNG, JPEG and EXR
  bool icc = false;                   // an ICC profile, in PNG and JPEG
  ImageTexts texts = {};              // in PNG and EXR
  std::optional<Shot> shot = {};      // in EXR
  std::optional<Region> region = {};  // that the image shows of a larger picture, in EXR
};

/// Writes `image` (3 or 4 channels, linear) in the format of the extension; the file appears whole or not at
/// all (temporary and rename). `aovs` become further channels of an EXR ("depth.Z", "normal.X"...); other
/// formats refuse them. Throws UsageError for an unknown extension, IoError when the file cannot be written.
void write_image(const Image& image, const std::filesystem::path& path, const AovImages& aovs = {},
                 const FileOptions& options = {});

/// OpenEXR's threads of this process become so many, or as many as there may be: they compress what is
/// written. Libraries leave their number to the program.
void share_exr_work(unsigned threads);

/// The bytes that `write_image` writes.
std::string encode_image(const Image& image, const std::filesystem::path& path, const AovImages& aovs = {},
                         const FileOptions& options = {});

/// Extensions that can be written, without the dot.
const std::vector<std::string>& image_formats();

/// Whether the alpha channel is omitted because programs would show coverage as holes.
bool drops_alpha(const std::filesystem::path& path);

/// Whether a file of this name is a PNG.
bool is_png(const std::filesystem::path& path);

/// The channels that a file of this name keeps of a frame: 3, or 4 with coverage.
inline int image_channels(const std::filesystem::path& path, bool transparent) {
  return drops_alpha(path) && !(transparent && is_png(path)) ? 3 : 4;
}

/// Whether a file of this name shows colours as a screen does, sRGB from 0 to 1: .png, .jpg, .jpeg.
bool is_for_screens(const std::filesystem::path& path);

/// The image as a file of this name shows it: for screens by the tone map and, if wanted, dithered to 8 bits.
Image shown_in(const std::filesystem::path& path, Image image, const ToneMap& map, bool dither = true);

/// The greatest value of a half float. An EXR of halves cuts colours off there.
constexpr float greatest_half = 65504;

/// Whether a file of this name keeps ImageTexts: .png, .exr.
bool keeps_texts(const std::filesystem::path& path);

/// Throws UsageError for an extension that `write_image` refuses. Call it before a long render.
void check_image_path(const std::filesystem::path& path, bool with_aovs);

/// Throws UsageError for a size that the format of that file cannot hold.
void check_image_size(const std::filesystem::path& path, int width, int height);

/// Reads an image as linear RGBA floats (8-bit and 16-bit PNG/JPEG are decoded from sRGB, unless a PNG states
/// another gamma; an EXR's colours become sRGB's, by its chromaticities). Throws SceneError on a bad file.
Image read_image(const std::filesystem::path& path);

/// An image, and whether the file has alpha; if not, the image's alpha is 1.
struct ImageInFile {
  Image image;
  bool alpha = false;
};
ImageInFile read_image_in_file(const std::filesystem::path& path);

/// Texts of a PNG or EXR; empty for other formats. Throws SceneError for a bad file.
ImageTexts read_texts(const std::filesystem::path& path);

/// The channels of an EXR besides those of its picture, as images by the names of their layers ("depth" of
/// "depth.Z"; a channel without a dot is a layer); empty for other formats. Throws SceneError on a bad file.
AovImages read_aovs(const std::filesystem::path& path);

float srgb_from_linear(float linear);
float linear_from_srgb(float srgb);

}  // namespace sundog
