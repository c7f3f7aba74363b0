// AOVs of light groups. Users write "light_NAME"; films, parts and workers use "light_NAME@NUMBER", where the
// number locates the group's sums.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/image_io.h"

namespace sundog {

inline constexpr const char *light_groups_aov = "light_groups", *rest_aov = "light_rest";

/// Whether `aov` belongs to a light group, with or without a number.
bool is_light_group(const std::string& aov);

/// Whether a film can have the AOV: one of aov_names(), or of a group, with its number.
bool is_aov(const std::string& name);

/// Throws UsageError unless is_aov(). The message begins with `option`.
void check_aov(const std::string& name, const std::string& option = "AOV ");

/// The number of an AOV's group; 0 without a number.
std::size_t number_of_group(const std::string& aov);

/// Adds numbers to the AOVs of light groups; the scene's groups are numbered from 1. "light_groups" expands
/// to all groups, "light_rest" is the lights in none. Throws UsageError for a group that the scene lacks, and
/// for parts of light beside groups, which share their memory.
std::vector<std::string> with_group_numbers(const std::vector<std::string>& aovs,
                                            std::span<const std::string> groups);

/// Renames the images back to names without numbers.
AovImages without_group_numbers(AovImages aovs);

}  // namespace sundog
