// Output files of commands: their formats and options, and that no output overwrites a file that was read,
// such as the scene, which is loaded here.
#pragma once
#include <string>
#include <vector>

#include "app/options/options.h"
#include "base/image_io.h"
#include "base/input.h"
#include "scene/load.h"

namespace sundog {

/// The file name whose extension is the picture's format; e.g. "picture.png" for the standard output.
std::string format_name(const PictureOptions& picture);

/// Whether the picture is dithered to 8 bits.
inline bool dithers(const PictureOptions& picture) { return !picture.no_dither && picture.bits == 8; }

/// The options with which the picture's file is written.
FileOptions file_options(const PictureOptions& picture);

/// Warns about colours that an EXR of half floats clips.
void warn_of_halves(const std::filesystem::path& path, const Image& image, const FileOptions& file);

/// Replaces infinite depths by --far. Throws UsageError if the AOV depth is missing.
void end_depth(const PictureOptions& picture, AovImages& aovs);

/// Throws UsageError if the picture's name has no known format, its format does not support an option, or the
/// standard output is a terminal; IoError if the file could not be written.
void check_picture(const PictureOptions& picture, bool with_aovs);

/// Throws UsageError if two outputs are the same file, or an output is an input file, by name or by a link.
/// Ignores empty names; "-" is the standard output or input.
void check_output_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// Throws UsageError if an output is one of the files that were read, such as textures and models.
void check_not_read(const std::vector<std::string>& outputs, const std::vector<ReadFile>& files);

/// Returns read(). Throws UsageError if it has read one of the outputs.
template <class Read>
auto read_apart_from(const std::vector<std::string>& outputs, const Read& read) {
  const ReadLog log;
  auto result = read();
  check_not_read(outputs, log.files());
  return result;
}

/// Loads a scene for a command that writes `outputs`, which must not be read.
SceneDescription load_for_command(const std::string& scene, const std::vector<std::string>& overrides,
                                  LoadOptions options, const std::vector<std::string>& outputs = {});

}  // namespace sundog
