#include "app/process/save_image.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cstdint>

#include "app/process/environment.h"
#include "app/process/standard_streams.h"
#include "base/error.h"
#include "base/file.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

/// The path, whose extension is the format.
fs::path named(const Picture& picture, const fs::path& path) {
  return is_standard_stream(path) ? fs::path("picture." + picture.format) : path;
}

void write(const Picture& picture, const fs::path& path) {
  const Image shown = shown_in(named(picture, path), picture.image, picture.tone_map, picture.dither);
  write_output(path,
               encode_image(shown, named(picture, path), picture.aovs,
                            picture.full_floats ? ExrColor::full : ExrColor::half, picture.texts),
               program_environment()->faults);
}

/// In (0, 1), spread so evenly over neighbours that no pattern is seen: the additive recurrence of the
/// plastic number in two dimensions, folded (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
/// Sequences"). It keeps away from 0 and 1, so that rounding of what 8 bits hold moves nothing.
double dither_threshold(std::size_t x, std::size_t y, std::size_t channel) {
  const auto turn = static_cast<std::uint32_t>(x * 3242174889u + y * 2447445413u + channel * 1431655765u);
  const std::uint32_t folded = turn < 0x80000000u ? turn * 2 : ~turn * 2;
  return (double(folded >> 24) + 0.5) / 256;
}

/// The linear values of the levels that 8 bits hold.
std::array<float, 256> make_levels() {
  std::array<float, 256> levels{};
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = linear_from_srgb(static_cast<float>(i) / 255);
  return levels;
}

void dither_colors(Image& image) {
  static const std::array<float, 256> levels = make_levels();
  const auto channels = static_cast<std::size_t>(image.channels),
             width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const std::size_t pixel = i / channels, channel = i % channels;
    float& value = image.data[i];
    if (channel >= 3 || !(value > 0 && value < 1)) continue;
    const double up = dither_threshold(pixel % width, pixel / width, channel);
    value = levels[static_cast<std::size_t>(255 * double(srgb_from_linear(value)) + up)];
  }
}

bool keep_checkpoint(const Picture& picture) {
  if (picture.checkpoint.empty()) return false;
  try {
    write_checkpoint(picture.checkpoint, picture.film, picture.key, program_environment()->faults);
    return true;
  } catch (const IoError&) {
    return false;
  }
}

/// Where the frame went instead, as the end of an error message. `write_to` writes the file that could not be
/// written to another place.
template <class Write>
std::string rescue(const Picture& picture, const fs::path& path, const char* what, const Write& write_to) {
  if (keep_checkpoint(picture))
    return fmt::format("; all of it is in {}: make room and give the same command again",
                       picture.checkpoint.string());
  std::string folder = (temporary_folder() / "sundog-XXXXXX").string();  // nobody else's link lies in its way
  const fs::path elsewhere = (::mkdtemp(folder.data()) ? fs::path(folder) : temporary_folder()) /
                             (what + named(picture, path).extension().string());
  try {
    write_to(elsewhere);
    return fmt::format("; the {} is in {}", what, elsewhere.string());
  } catch (const IoError&) {
    ::rmdir(folder.c_str());
    return fmt::format("; {} cannot be written either, and it is lost", temporary_folder().string());
  }
}

template <class Write>
void save(const Picture& picture, const fs::path& path, const char* what, const Write& write_to) {
  try {
    write_to(path);
  } catch (const IoError& error) {
    throw IoError(error.what() + rescue(picture, path, what, write_to));
  }
}

}  // namespace

Image shown_in(const fs::path& path, Image image, const ToneMap& map, bool dither) {
  if (!has_eight_bits(path)) return image;
  apply(map, image);
  if (dither) dither_colors(image);
  return image;
}

void save_image(const Picture& picture, const fs::path& path) {
  save(picture, path, "image", [&](const fs::path& to) { write(picture, to); });
}

void save_part(const Picture& picture, const PartHeader& header, const fs::path& path) {
  save(picture, path, "part",
       [&](const fs::path& to) { write_part(to, header, picture.film, program_environment()->faults); });
}

}  // namespace sundog
