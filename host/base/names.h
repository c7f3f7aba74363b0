// Misspelt names.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sundog {

/// The name most like `found`, or nothing: a third of its letters may be missing, added, changed or swapped
/// with their neighbours, but not all of them. Upper and lower case count as the same.
std::optional<std::string> nearest_name(std::string_view found, const std::vector<std::string>& names);

/// "did you mean "NAME"?" where there is a nearest name, else `otherwise`. `quote` goes around the name.
std::string did_you_mean(std::string_view found, const std::vector<std::string>& names,
                         const std::string& otherwise = "", std::string_view quote = "\"");

}  // namespace sundog
