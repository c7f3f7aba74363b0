// A part of a frame as a file, for machines that share nothing but a folder; and the frame from its parts.
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

/// The rows of a part: bands over the whole height, so that each part has about the same work. Parts that are
/// more than there are bands have none.
std::vector<RowRange> part_rows(int height, const PartOfFrame& part);

/// The header of a part's file.
struct PartHeader {
  PartOfFrame part;
  std::uint64_t key = 0;                        // hash_scene(): of the scene with its settings
  std::string scene;                            // the scene's file, for messages
  std::map<std::string, std::string> settings;  // what was set and may differ, for messages
  std::vector<std::string> aovs;                // in the order they were asked for
  Shot shot{};                                  // for an EXR of the whole frame
  MatteNames names{};                           // with AOVs of Cryptomatte
};

struct PartFile : PartHeader {
  Film film;  // the part's pixels are done
};

/// Only pixels that are done take room. Throws IoError.
void write_part(const std::filesystem::path& path, const PartHeader& header, const Film& film,
                const std::shared_ptr<Faults>& faults = nullptr);

/// Throws IoError when it cannot be read, SceneError when it is no part or damaged.
PartFile read_part(const std::filesystem::path& path);

/// The whole frame. Throws SceneError for parts of different scenes or settings, of different divisions,
/// parts that are missing, there twice, or not complete.
PartFile merge_parts(const std::vector<std::filesystem::path>& paths);

}  // namespace sundog
