// Reads and writes image files. The extension selects the format to write: .png (8 or 16 bits, sRGB), .jpg
// (8 bits, sRGB), .exr, .hdr or .pfm. Readers recognise the format by the content.
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

/// Named texts about an image, such as the program and scene that made it. PNG and EXR store them.
using ImageTexts = std::vector<std::pair<std::string, std::string>>;

/// An EXR's colour space.
enum class ExrSpace { srgb, acescg };

/// How a file stores its pixels, and its metadata. Formats ignore options that they cannot store.
struct FileOptions {
  ExrColor color = ExrColor::half;
  ExrSpace space = ExrSpace::srgb;
  int bits = 8;                       // PNG: bits per channel, 8 or 16
  int dpi = 72;                       // PNG, JPEG, EXR: pixels per inch, for printers
  bool icc = false;                   // PNG, JPEG: with an ICC profile
  ImageTexts texts = {};              // PNG, EXR
  std::optional<Shot> shot = {};      // EXR
  std::optional<Region> region = {};  // EXR: the image's place in a larger picture
};

/// Writes `image` (3 or 4 channels, linear) in the format of the extension; the file appears whole or not at
/// all (temporary and rename). `aovs` become additional channels of an EXR ("depth.Z", "normal.X"...). Throws
/// UsageError for an unknown extension or AOVs in another format, IoError if the file cannot be written.
void write_image(const Image& image, const std::filesystem::path& path, const AovImages& aovs = {},
                 const FileOptions& options = {});

/// Sets the number of OpenEXR's threads in this process, which compress written files, or to as many as can
/// be started. For programs; a library must not change it.
void share_exr_work(unsigned threads);

/// The bytes that write_image() would write.
std::string encode_image(const Image& image, const std::filesystem::path& path, const AovImages& aovs = {},
                         const FileOptions& options = {});

/// Extensions that can be written, without the dot.
const std::vector<std::string>& image_formats();

/// Whether files of this format omit alpha by default, because programs would show coverage as holes.
bool drops_alpha(const std::filesystem::path& path);

/// Whether a file of this name is a PNG.
bool is_png(const std::filesystem::path& path);

/// The number of channels that a file of this name stores: 3, or 4 with coverage.
inline int image_channels(const std::filesystem::path& path, bool transparent) {
  return drops_alpha(path) && !(transparent && is_png(path)) ? 3 : 4;
}

/// Whether a file of this name holds screen colours, sRGB from 0 to 1: .png, .jpg, .jpeg.
bool is_for_screens(const std::filesystem::path& path);

/// The image as a file of this name stores it: for screens, tone mapped and optionally dithered to 8 bits.
Image shown_in(const std::filesystem::path& path, Image image, const ToneMap& map, bool dither = true);

/// The greatest half float. An EXR of halves clips colours there.
constexpr float greatest_half = 65504;

/// Whether a file of this name can store ImageTexts: .png, .exr.
bool keeps_texts(const std::filesystem::path& path);

/// Throws UsageError for an extension that write_image() refuses. Call it before a long render.
void check_image_path(const std::filesystem::path& path, bool with_aovs);

/// Throws UsageError for a size that the file's format cannot hold.
void check_image_size(const std::filesystem::path& path, int width, int height);

/// Reads an image as linear RGBA floats. PNG and JPEG are decoded from sRGB, unless a PNG states another
/// gamma; an EXR's colours are converted to sRGB primaries. Throws SceneError for a bad file.
Image read_image(const std::filesystem::path& path);

/// An image, and whether the file has alpha; if not, the image's alpha is 1.
struct ImageInFile {
  Image image;
  bool alpha = false;
};
ImageInFile read_image_in_file(const std::filesystem::path& path);

/// Texts of a PNG or EXR; empty for other formats. Throws SceneError for a bad file.
ImageTexts read_texts(const std::filesystem::path& path);

/// An EXR's channels other than its picture, as one image per layer ("depth" for "depth.Z"; a channel without
/// a dot is its own layer); empty for other formats. Throws SceneError for a bad file.
AovImages read_aovs(const std::filesystem::path& path);

float srgb_from_linear(float linear);
float linear_from_srgb(float srgb);

}  // namespace sundog
