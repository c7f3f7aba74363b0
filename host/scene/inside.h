// Files that a scene or a model names.
#pragma once
#include <filesystem>

namespace sundog {

/// Whether `named`, a path that `file` names, leaves the folder of `file`: absolutely, by "..", or by a link.
/// Nothing is opened.
bool leads_outside(const std::filesystem::path& file, const std::filesystem::path& named);

/// The mend, as the end of a message.
inline constexpr const char* outside_hint = "allow files outside of it if it is to be read all the same";

}  // namespace sundog
