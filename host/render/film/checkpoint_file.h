// What both kinds of checkpoints are read with. Their files may be forged: every value is checked before it
// is used.
#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/input.h"

namespace sundog {

inline SceneError damaged_checkpoint(const std::filesystem::path& path) {
  return {path.string(), "", "is no sundog checkpoint, or is damaged; remove it to start anew"};
}

inline UsageError other_checkpoint(const std::filesystem::path& path) {
  return UsageError(path.string() +
                    ": is a checkpoint of another scene or of other settings; remove it to start anew");
}

/// The file's bytes. Throws UsageError, before it is read, for a file of more than `most`: the frame has none
/// of that size.
inline std::string read_checkpoint_bytes(const std::filesystem::path& path, std::uintmax_t most) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  if (!failed && size > most) throw other_checkpoint(path);
  return read_input(path, most);
}

/// Whether each is 0 or 1.
inline bool all_flags(const std::vector<std::uint8_t>& flags) {
  return std::ranges::all_of(flags, [](std::uint8_t flag) { return flag <= 1; });
}

}  // namespace sundog
