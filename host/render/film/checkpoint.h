// Checkpoints: the state of an incomplete frame as a file. Files may be forged: each value is checked before
// it is used.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "render/film/pass.h"

namespace sundog {

class Faults;

SceneError damaged_checkpoint(const std::filesystem::path& path);

/// Writes the film of the complete passes, the current pass, and its finished pixels `made`. A pass without
/// pixels means that the film is complete. `key` identifies scene and settings. Throws IoError.
void write_checkpoint(const std::filesystem::path& path, const Film& film, const Pass& pass, const Film& made,
                      std::uint64_t key, const std::shared_ptr<Faults>& faults = nullptr);

/// Reads a checkpoint. `film` has the frame's size and needs, and no pixels. Checks everything except the
/// pass's samples, which the plan knows (may_be_of()). Throws UsageError if the checkpoint belongs to another
/// scene, setting or version, SceneError if it is damaged.
void read_checkpoint(const std::filesystem::path& path, Film& film, Pass& pass, Film& made,
                     std::uint64_t key);

}  // namespace sundog
