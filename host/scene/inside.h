// Containment of files that a scene or model names.
#pragma once
#include <filesystem>

namespace sundog {

/// Whether the path `named`, given in `file`, leaves the folder of `file`: absolute, by "..", or by a link.
/// Opens nothing.
bool leads_outside(const std::filesystem::path& file, const std::filesystem::path& named);

/// The remedy, as the end of a message.
inline constexpr const char* outside_hint = "allow files outside of it if it is to be read all the same";

}  // namespace sundog
