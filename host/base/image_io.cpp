// Picks the codec for an image file, and adds the file's name to errors.
#include "base/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "base/error.h"
#include "base/file.h"
#include "base/input.h"
#include "base/limits.h"
#include "base/pixels/image_codecs.h"
#include "base/pixels/stored_image.h"

namespace sundog {
namespace fs = std::filesystem;
namespace {

bool is_exr(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

Image decode(std::string_view bytes) {
  if (is_exr(bytes)) return decode_exr(bytes);
  if (bytes.starts_with("PF") || bytes.starts_with("Pf")) return decode_pfm(bytes);
  if (bytes.starts_with("#?")) return decode_hdr(bytes);
  return linear_image(decode_stored(bytes));
}

/// Calls `read(bytes)`; converts its exceptions to a SceneError about the file.
template <class Read>
auto read_named(const fs::path& path, const Read& read) {
  const std::string bytes = read_input(path, most_frame_bytes);
  try {
    return read(std::string_view(bytes));
  } catch (const std::bad_alloc&) {
    throw SceneError(path.string(), "", "the image is too large for this machine's memory");
  } catch (const std::exception& error) {
    throw SceneError(path.string(), "", error.what());
  }
}

}  // namespace

float srgb_from_linear(float linear) {
  if (linear <= 0.0031308f) return linear * 12.92f;
  return 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float linear_from_srgb(float srgb) {
  if (srgb <= 0.04045f) return srgb / 12.92f;
  return std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

void check_image_path(const fs::path& path, bool with_aovs) {
  const std::string extension = lower_extension(path);
  if (extension == ".exr") return;
  const auto& formats = image_formats();
  if (extension.empty() || std::ranges::count(formats, extension.substr(1)) == 0)
    throw UsageError(
        fmt::format("{}: wanted an image file name that ends in .png, .jpg, .exr, .hdr or .pfm, found {}",
                    path.string(), extension.empty() ? "no extension" : extension));
  if (with_aovs)
    throw UsageError(fmt::format("{}: only .exr files hold AOVs; use an .exr name or no AOV", path.string()));
}

const std::vector<std::string>& image_formats() {
  static const std::vector<std::string> formats = {"png", "jpg", "jpeg", "exr", "hdr", "pfm"};
  return formats;
}

bool drops_alpha(const fs::path& path) { return lower_extension(path) != ".exr"; }

bool is_png(const fs::path& path) { return lower_extension(path) == ".png"; }

bool is_for_screens(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return is_png(path) || extension == ".jpg" || extension == ".jpeg";
}

Image shown_in(const fs::path& path, Image image, const ToneMap& map, bool dither) {
  if (!is_for_screens(path)) return image;
  prepare_for_screen(image, map, dither);
  return image;
}

bool keeps_texts(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".png" || extension == ".exr";
}

void check_image_size(const fs::path& path, int width, int height) {
  const std::string extension = lower_extension(path);
  const bool jpeg = extension == ".jpg" || extension == ".jpeg";
  constexpr int most_side = 65535;          // a JPEG header's limit
  constexpr int most_samples = 0x7fffffff;  // stb_image_write counts in int
  const bool too_many = 3 * std::int64_t{width} * height > most_samples;
  if ((jpeg && (too_many || std::max(width, height) > most_side)) || (extension == ".hdr" && too_many))
    throw UsageError(fmt::format(
        "{}: {}x{} pixels are too many for a {} file (at most {}{} in all): use .png or .exr", path.string(),
        width, height, extension.substr(1), jpeg ? "65535 each way, " : "", most_samples / 3));
}

std::string encode_image(const Image& image, const fs::path& path, const AovImages& aovs,
                         const FileOptions& options) {
  check_image_path(path, !aovs.empty());
  check_image_size(path, image.width, image.height);
  const std::string extension = lower_extension(path);
  const auto encode = [&] {
    if (extension == ".exr") return encode_exr(image, aovs, options);
    if (extension == ".hdr") return encode_hdr(image);
    if (extension == ".pfm") return encode_pfm(image);
    if (extension == ".jpg" || extension == ".jpeg") return encode_jpeg(image, options);
    return encode_png(image, options);
  };
  try {
    return encode();
  } catch (const IoError&) {
    throw;
  } catch (const std::exception& error) {
    throw IoError(path.string(), fmt::format("cannot be written: {}", error.what()));
  }
}

void write_image(const Image& image, const fs::path& path, const AovImages& aovs,
                 const FileOptions& options) {
  write_file(path, encode_image(image, path, aovs, options));
}

Image read_image(const fs::path& path) { return read_named(path, decode); }

ImageInFile read_image_in_file(const fs::path& path) {
  return read_named(path,
                    [](std::string_view bytes) { return ImageInFile{decode(bytes), has_alpha(bytes)}; });
}

ImageTexts read_texts(const fs::path& path) {
  return read_named(path, [](std::string_view bytes) {
    return is_exr(bytes) ? decode_exr_texts(bytes) : decode_png_texts(bytes);
  });
}

AovImages read_aovs(const fs::path& path) {
  return read_named(
      path, [](std::string_view bytes) { return is_exr(bytes) ? decode_exr_aovs(bytes) : AovImages(); });
}

}  // namespace sundog
