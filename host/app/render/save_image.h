// The end of a render: the image, or a part of the frame, on disk, or, when the disk fails, kept where it can
// be.
#pragma once
#include <filesystem>
#include <string>

#include "base/image_io.h"
#include "render/film/film.h"
#include "render/film/part.h"

namespace sundog {

/// A frame to save: its image and AOVs, and the film that they were developed from.
struct Picture {
  Image image;  // linear, of image_channels() of the file; none of a part
  const AovImages& aovs;
  const Film& film;
  std::uint64_t key = 0;  // of the scene, for a checkpoint
  // Takes the film if `path` cannot be written; empty: none was asked for.
  std::filesystem::path checkpoint = {};
  bool checkpoint_kept = false;  // the frame is there
  std::string format = "png";    // of image_formats(), where the path is "-"
  FileOptions file = {};
  ToneMap tone_map = {};
  bool dithered = true;
};

/// Writes the image as a file of its name shows it (shown_in()) to `path`; "-" is the standard output. Warns
/// of colours that the file cuts off. When that fails the frame is kept as a checkpoint, or as an image in
/// the folder for temporary files: IoError says what happened and where it is.
void save_image(Picture picture, const std::filesystem::path& path);

/// Writes a part of a frame to `path`; keeps it elsewhere if that fails, as save_image() does.
void save_part(const Picture& picture, const PartHeader& header, const std::filesystem::path& path);

}  // namespace sundog
