// Names in lower case, and suggestions from a list for a misspelt name.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sundog {

/// The text with ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// The name closest to `found`, ignoring case; none if more than a third of its letters, or all of them,
/// would have to be added, dropped, changed or swapped with a neighbour.
std::optional<std::string> nearest_name(std::string_view found, const std::vector<std::string>& names);

/// Returns `did you mean "NAME"?` if there is a nearest name, else `otherwise`. `quote` surrounds the name.
std::string did_you_mean(std::string_view found, const std::vector<std::string>& names,
                         const std::string& otherwise = "", std::string_view quote = "\"");

}  // namespace sundog
