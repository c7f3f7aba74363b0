// Declares the options with their help and limits, and checks --format; output_files.h checks the others.
#include "app/options/picture_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/options/option_helpers.h"
#include "app/process/standard_streams.h"
#include "base/error.h"
#include "base/image_io.h"
#include "base/names.h"

namespace sundog {

void add_tone_options(Arguments* app, PictureOptions& picture) {
  for (const ToneOption& one : tone_options)
    value(app, one.option, one.unit, picture.tone[one.key], one.help);
}

void add_picture(Arguments* app, PictureOptions& picture) {
  value(app, "-o,--out", "FILE", picture.out,
        "image file: .png, .jpg, .exr, .hdr or .pfm; -: the standard output")
      ->required();
  value(app, "--format", "NAME", picture.format,
        fmt::format("of the image that -o - writes: {} (default: png)", fmt::join(image_formats(), ", ")));
  app->add_flag("--float", picture.full_floats, "keep an .exr's colours as 32-bit floats (default: half)");
  value(app, "--color-space", "NAME", picture.color_space, "of an .exr's colours: srgb (default) or acescg")
      ->one_of({"srgb", "acescg"});
  value(app, "--bits", "N", picture.bits, "of a .png's channels: 8 (default) or 16")->one_of({"8", "16"});
  add_tone_options(app, picture);
  value(app, "--dpi", "N", picture.dpi, "pixels an inch that .png, .jpg and .exr state (default 72)")
      ->range(1, 65535);
  app->add_flag("--icc", picture.icc, "put an ICC profile, that of sRGB, into .png and .jpg");
  value(app, "--far", "Z", picture.far, "the AOV depth where nothing is (default: infinite)");
  app->add_flag("--no-dither", picture.no_dither, "round colours of .png and .jpg to the nearest of 8 bits");
}

void check_format(PictureOptions& picture) {
  const auto& known = image_formats();
  if (!picture.format.empty() && !is_standard_stream(picture.out))
    throw UsageError("--format is for -o -: a file's name says its format");
  if (!picture.format.empty() && std::ranges::count(known, picture.format) == 0)
    throw UsageError(fmt::format(
        "--format {}: {}", picture.format,
        did_you_mean(picture.format, known, fmt::format("wanted one of {}", fmt::join(known, ", ")), "")));
  if (picture.format.empty()) picture.format = "png";
}

}  // namespace sundog
