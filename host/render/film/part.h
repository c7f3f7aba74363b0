// Parts of a frame as files, for machines that share nothing but a folder, and the frame merged from them.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/pixels/shot.h"
#include "render/film/cryptomatte.h"
#include "render/film/film.h"
#include "render/film/rows.h"
#include "render/values/options.h"

namespace sundog {

/// The rows of a part: bands spread over the whole height, so that parts take about equally long. Empty if
/// there are more parts than bands.
std::vector<RowRange> part_rows(int height, const PartOfFrame& part);

/// The header of a part's file.
struct PartHeader {
  PartOfFrame part;
  std::uint64_t key = 0;                        // hash_scene() of the scene and its settings
  std::string scene;                            // the scene's file, for messages
  std::map<std::string, std::string> settings;  // settings that may differ, for messages
  std::vector<std::string> aovs;                // in the requested order
  Shot shot{};                                  // for an EXR of the whole frame
  MatteNames names{};                           // with Cryptomatte AOVs
};

struct PartFile : PartHeader {
  Film film;  // the part's pixels are done
};

/// Writes only the finished pixels. Throws IoError.
void write_part(const std::filesystem::path& path, const PartHeader& header, const Film& film,
                const std::shared_ptr<Faults>& faults = nullptr);

/// Throws IoError if the file cannot be read, SceneError if it is not a part or is damaged.
PartFile read_part(const std::filesystem::path& path);

/// Merges the whole frame. Throws SceneError if parts differ in scene, settings or division, or are missing,
/// duplicate or incomplete.
PartFile merge_parts(const std::vector<std::filesystem::path>& paths);

}  // namespace sundog
