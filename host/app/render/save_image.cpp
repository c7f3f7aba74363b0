// Encodes and writes the image; on failure, writes a checkpoint, or the image to the temporary folder.
#include "app/render/save_image.h"

#include <fmt/format.h>

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "app/process/environment.h"
#include "app/process/standard_streams.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/file.h"
#include "render/film/checkpoint.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

/// A path whose extension is the picture's format.
fs::path named(const Picture& picture, const fs::path& path) {
  return is_standard_stream(path) ? fs::path("picture." + picture.format) : path;
}

void write(const Picture& picture, const fs::path& path) {
  constexpr std::size_t large = 1 << 20;  // with more values, compressing takes longer than starting threads
  if (lower_extension(named(picture, path)) == ".exr" &&
      picture.image.data.size() * (1 + picture.aovs.size()) > large)
    share_exr_work(std::clamp(std::thread::hardware_concurrency(), 1u, 16u));
  write_output(path, encode_image(picture.image, named(picture, path), picture.aovs, picture.file),
               program_environment()->faults);
}

bool keep_checkpoint(const Picture& picture) {
  if (picture.checkpoint.empty() || picture.checkpoint_kept) return picture.checkpoint_kept;
  try {
    write_checkpoint(picture.checkpoint, picture.film, Pass(), Film(), picture.key,
                     program_environment()->faults);
    return true;
  } catch (const IoError&) {
    return false;
  }
}

/// Keeps the frame elsewhere. Returns where, as the end of an error message. `write_to` writes to a path.
template <class Write>
std::string rescue(const Picture& picture, const fs::path& path, const char* what, const Write& write_to) {
  if (keep_checkpoint(picture))
    return fmt::format("; all of it is in {}: make room and give the same command again",
                       picture.checkpoint.string());
  std::string folder =
      (temporary_folder() / "sundog-XXXXXX").string();  // a private folder avoids others' links
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

void save_image(Picture picture, const fs::path& path) {
  picture.image =
      shown_in(named(picture, path), std::move(picture.image), picture.tone_map, picture.dithered);
  save(picture, path, "image", [&](const fs::path& to) { write(picture, to); });
  warn_of_halves(named(picture, path), picture.image, picture.file);
}

void save_part(const Picture& picture, const PartHeader& header, const fs::path& path) {
  save(picture, path, "part",
       [&](const fs::path& to) { write_part(to, header, picture.film, program_environment()->faults); });
}

}  // namespace sundog
