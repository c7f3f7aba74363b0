// AOVs of light groups. People write "light_NAME"; films, parts and workers know them as "light_NAME@NUMBER",
// with the place of their sums.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/image_io.h"

namespace sundog {

inline constexpr const char *light_groups_aov = "light_groups", *rest_aov = "light_rest";

/// Whether it is an AOV of a light group, with a number or without.
bool is_light_group(const std::string& aov);

/// The number of an AOV's group; 0 without one.
std::size_t number_of_group(const std::string& aov);

/// The AOVs with numbers, by the scene's groups, which are numbered from 1 on: "light_groups" stands for all,
/// "light_rest" for lights in none. Throws UsageError for a group that the scene has not, and where parts of
/// light, which take the same place, are asked for as well.
std::vector<std::string> with_group_numbers(const std::vector<std::string>& aovs,
                                            std::span<const std::string> groups);

/// The images under their names without numbers.
AovImages without_group_numbers(AovImages aovs);

}  // namespace sundog
