// Checks of output files before a command runs: their formats, and that no output overwrites an input.
#pragma once
#include <string>
#include <vector>

#include "app/options/options.h"
#include "base/image_io.h"
#include "base/input.h"

namespace sundog {

/// The name that the picture's format is read from: that of the file, or "picture.png" for the standard
/// output.
std::string format_name(const PictureOptions& picture);

/// Whether its colours are rounded to 8 bits by chance.
inline bool dithers(const PictureOptions& picture) { return !picture.no_dither && picture.bits == 8; }

/// How that file is written.
FileOptions file_options(const PictureOptions& picture);

/// Warns of colours that an EXR of halves cuts off.
void warn_of_halves(const std::filesystem::path& path, const Image& image, const FileOptions& file);

/// The AOVs that a frame makes: those asked for, and those that the denoiser wants.
std::vector<std::string> made_aovs(const RenderCommand& command);

/// Replaces infinite depths by those of --far. Throws UsageError where there are no depths.
void end_depth(const PictureOptions& picture, AovImages& aovs);

/// Throws UsageError where the picture's name is of no format, or its format cannot hold what is asked, or
/// the standard output is a terminal; IoError where the file could not be written.
void check_picture(const PictureOptions& picture, bool with_aovs);

/// Throws UsageError where two of the outputs are one file, or an output is a file that is read, under this
/// name or by a link. Empty names are none; "-" is the standard output, or input.
void check_output_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// Throws UsageError where an output is a file that was read meanwhile: a texture, a model, a file of theirs.
void check_not_read(const std::vector<std::string>& outputs, const std::vector<ReadFile>& files);

/// Returns load(). Throws UsageError if it read one of the outputs.
template <class Load>
auto load_and_check_outputs(const std::vector<std::string>& outputs, const Load& load) {
  const ReadLog log;
  auto loaded = load();
  check_not_read(outputs, log.files());
  return loaded;
}

}  // namespace sundog
