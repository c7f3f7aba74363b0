// Writes an image or a part of a frame; on failure, keeps it in a checkpoint or the temporary folder.
#pragma once
#include <filesystem>
#include <string>

#include "base/image_io.h"
#include "render/film/film.h"
#include "render/film/part.h"

namespace sundog {

/// A frame to save: its image and AOVs, and the film that they were developed from.
struct Picture {
  Image image;  // linear, with the file's image_channels(); empty for a part
  const AovImages& aovs;
  const Film& film;
  std::uint64_t key = 0;  // the scene's key, for a checkpoint
  // Receives the film if `path` cannot be written; empty: none.
  std::filesystem::path checkpoint = {};
  bool checkpoint_kept = false;  // the checkpoint already holds the frame
  std::string format = "png";    // one of image_formats(), for the path "-"
  FileOptions file = {};
  ToneMap tone_map = {};
  bool dithered = true;
};

/// Writes the image, as shown_in() a file of its name, to `path`; "-" is the standard output. Warns about
/// colours that the file clips. On failure, keeps the frame as a checkpoint, or as an image in the temporary
/// folder, and throws an IoError that says what happened and where the frame is.
void save_image(Picture picture, const std::filesystem::path& path);

/// Writes a part of a frame to `path`; keeps it elsewhere if that fails, as save_image() does.
void save_part(const Picture& picture, const PartHeader& header, const std::filesystem::path& path);

}  // namespace sundog
