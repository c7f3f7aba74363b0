// Suggestions for misspelt names.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sundog {

/// The name closest to `found`, ignoring case, or nothing. Up to a third of its letters may be missing,
/// added, changed or swapped with a neighbour, but not all of them.
std::optional<std::string> nearest_name(std::string_view found, const std::vector<std::string>& names);

/// Returns `did you mean "NAME"?` if there is a nearest name, else `otherwise`. `quote` surrounds the name.
std::string did_you_mean(std::string_view found, const std::vector<std::string>& names,
                         const std::string& otherwise = "", std::string_view quote = "\"");

}  // namespace sundog
